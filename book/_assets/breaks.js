// Where lines end: a long name or address in the text breaks after a stop, a slash or an underscore, not inside a word.
(function () {
  // Letters; in a table, which scrolls, names stay whole longer.
  const LONG = 14;
  const LONG_IN_TABLE = 23;
  const PARTS = /(?<=[._/:=(])(?=[^\s._/:=()])|(?<=[a-z]{3})(?=[A-Z][a-z]{2})/;
  const WORDS = 20; // letters in a cell of a table from which on it is words
  const LINES = 36; // letters in a cell of the first column from which on it is lines of words

  function breakable(text) {
    const long = text.parentElement.closest("table") ? LONG_IN_TABLE : LONG;
    if (!text.textContent.split(/\s/).some((word) => word.length > long && PARTS.test(word))) return;
    const pieces = text.textContent.split(PARTS);
    text.replaceWith(...pieces.flatMap((piece, place) => (place ? [document.createElement("wbr"), piece] : [piece])));
  }

  document.addEventListener("DOMContentLoaded", function () {
    for (const cell of document.querySelectorAll(".bd-article td:nth-child(2)")) {
      cell.classList.toggle("of-words", cell.textContent.trim().length > WORDS);
    }
    for (const cell of document.querySelectorAll(".bd-article td:first-child")) {
      cell.classList.toggle("of-lines", cell.textContent.trim().length > LINES);
    }
    const names = ":is(:not(pre) > code, a.reference.external, dl.py dt, td > p)";
    for (const name of document.querySelectorAll(`.bd-article ${names}`)) {
      if (name.closest("pre, .math") || name.dataset.breakable) continue;
      const texts = document.createTreeWalker(name, NodeFilter.SHOW_TEXT);
      const found = [];
      while (texts.nextNode()) if (!texts.currentNode.parentElement.closest(".math")) found.push(texts.currentNode);
      found.forEach(breakable);
      name.dataset.breakable = "yes";
    }
  });
})();
