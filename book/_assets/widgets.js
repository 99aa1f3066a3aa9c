// Before RequireJS: everything it looks for, the fonts of the widgets among it, lies in the book's own folder.
window.require = { baseUrl: new URL("vendor/", document.currentScript.src).href };

// The widgets speak to MathJax 2; the book sets its equations with MathJax 3.
document.addEventListener("DOMContentLoaded", function () {
  if (window.MathJax) {
    MathJax.Hub = { Queue: ([, , element]) => MathJax.startup.promise.then(() => MathJax.typesetPromise([element])) };
  }
});
