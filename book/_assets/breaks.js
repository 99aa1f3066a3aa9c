// A long name or address in the text breaks after a stop, a slash or an underscore, not inside a word.
(function () {
  // Letters; in a table, which scrolls, names stay whole longer.
  const LONG = 14;
  const LONG_IN_TABLE = 23;
  const PARTS = /(?<=[._/:=(])(?=[^\s._/:=()])/;

  function breakable(text) {
    const long = text.parentElement.closest("table") ? LONG_IN_TABLE : LONG;
    if (!text.textContent.split(/\s/).some((word) => word.length > long && PARTS.test(word))) return;
    const pieces = text.textContent.split(PARTS);
    text.replaceWith(...pieces.flatMap((piece, place) => (place ? [document.createElement("wbr"), piece] : [piece])));
  }

  document.addEventListener("DOMContentLoaded", function () {
    const names = ":is(:not(pre) > code, a.reference.external, dl.py dt)";
    for (const name of document.querySelectorAll(`.bd-article ${names}`)) {
      if (name.closest("pre") || name.dataset.breakable) continue;
      const texts = document.createTreeWalker(name, NodeFilter.SHOW_TEXT);
      const found = [];
      while (texts.nextNode()) found.push(texts.currentNode);
      found.forEach(breakable);
      name.dataset.breakable = "yes";
    }
  });
})();
