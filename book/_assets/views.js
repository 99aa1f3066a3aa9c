// Draws the views that turn. A notebook leaves <figure class="turning-view"> with the figure as JSON in a script
// element; Plotly is fetched from the book's own folder, and only by pages that need it.
(function () {
  const here = document.currentScript.src;

  function draw(view) {
    const figure = JSON.parse(view.querySelector('script[type="application/json"]').textContent);
    const target = view.querySelector(".turning-view-canvas");
    Plotly.newPlot(target, figure.data, figure.layout, {
      displaylogo: false,
      responsive: true,
      scrollZoom: false, // the wheel moves the page
    });
  }

  document.addEventListener("DOMContentLoaded", function () {
    const views = document.querySelectorAll(".turning-view");
    if (views.length === 0) return;
    const script = document.createElement("script");
    script.src = new URL("vendor/plotly/plotly-gl3d.min.js", here).href;
    script.onload = () => views.forEach(draw);
    document.head.appendChild(script);
  });
})();
