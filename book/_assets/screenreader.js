// What widgets and Sphinx leave unsaid to a screen reader.
(function () {
  // A slider takes its name from the label beside it, and the value it stands for from the readout.
  function nameSliders() {
    document.querySelectorAll(".widget-slider .noUi-handle:not([aria-label])").forEach(function (handle) {
      const widget = handle.closest(".widget-slider");
      const label = widget.querySelector(".widget-label");
      const readout = widget.querySelector(".widget-readout");
      handle.setAttribute("aria-label", label ? label.textContent.trim() : "position");
      if (readout) {
        readout.id = readout.id || "slider-readout-" + document.querySelectorAll("[id^=slider-readout-]").length;
        handle.setAttribute("aria-describedby", readout.id);
      }
    });
  }

  // What scrolls sideways can be reached and moved with the keyboard.
  function reachFigures() {
    for (const figure of document.querySelectorAll(".bd-article figure:has(> img)")) {
      if (figure.scrollWidth > figure.clientWidth + 1) figure.setAttribute("tabindex", "0");
      else figure.removeAttribute("tabindex");
    }
  }

  window.addEventListener("load", reachFigures);
  window.addEventListener("resize", reachFigures);

  // Tables and equations that scroll say so (book.css has the words). Their size changes when MathJax has set them.
  const TABLES = ".pst-scrollable-table-container, .cell_output .text_html, div.table";
  function sayWhatMoves() {
    const isWide = (box) => box !== null && box.scrollWidth > box.clientWidth + 1;
    for (const box of document.querySelectorAll(`.bd-article :is(${TABLES})`)) {
      box.classList.toggle("moves-sideways", isWide(box));
      if (isWide(box)) box.setAttribute("tabindex", "0");
    }
    for (const box of document.querySelectorAll(".bd-article div.math")) {
      const formula = box.querySelector('mjx-container[display="true"]');
      box.classList.toggle("moves-sideways", isWide(box) || isWide(formula));
    }
  }

  window.addEventListener("load", function () {
    const watch = new ResizeObserver(() => window.requestAnimationFrame(sayWhatMoves));
    document.querySelectorAll(`.bd-article :is(${TABLES}, div.math)`).forEach((box) => watch.observe(box));
    sayWhatMoves();
  });

  document.addEventListener("DOMContentLoaded", function () {
    // The entries are no list items, so that their frame is no list.
    document.querySelectorAll(".citation-list[role=list]").forEach((list) => list.removeAttribute("role"));
    if (document.querySelector('script[type="application/vnd.jupyter.widget-view+json"]')) {
      nameSliders();
      new MutationObserver(nameSliders).observe(document.body, { childList: true, subtree: true });
    }
  });
})();
