// In the code of the chapters, `fg.NAME` leads to the name's place on the page of public names.
(function () {
  const here = document.currentScript.src;

  function follows(element, text) {
    const next = element.nextSibling;
    return next && next.nodeType === Node.ELEMENT_NODE && next.textContent === text ? next : null;
  }

  document.addEventListener("DOMContentLoaded", function () {
    // The printed book is one page.
    const page = document.getElementById("facegear.Drive") ? "" : new URL("../api.html", here).href;
    for (const module of document.querySelectorAll(".bd-article .highlight span.n")) {
      const dot = module.textContent === "fg" ? follows(module, ".") : null;
      const name = dot && dot.nextSibling;
      if (!name || name.nodeType !== Node.ELEMENT_NODE || !/^\w+$/.test(name.textContent)) continue;
      const link = document.createElement("a");
      link.href = `${page}#facegear.${name.textContent}`;
      link.className = "code-link";
      name.replaceWith(link);
      link.append(name);
    }
  });
})();
