// What the page does besides being read: theme, pictures, charts that answer to the mouse.
// Texts from the data go in as text only.
(function () {
  "use strict";

  const data = JSON.parse(document.getElementById("data").textContent);
  const page = (window.tubetwin = window.tubetwin || {});

  page.bytes = function (base64) {
    const text = atob(base64);
    const out = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
    return out;
  };
  // Little-endian 16-bit integers, as the program writes them.
  page.shorts = function (base64) {
    const bytes = page.bytes(base64);
    const view = new DataView(bytes.buffer);
    const out = new Int16Array(bytes.length / 2);
    for (let i = 0; i < out.length; ++i) out[i] = view.getInt16(2 * i, true);
    return out;
  };
  page.colour = function (name) {
    return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  };
  page.onTheme = [];

  // Theme: what the system says until the button is used.
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const retheme = function () {
    for (const listener of page.onTheme) listener();
  };
  const button = document.getElementById("theme");
  button.hidden = false;
  button.addEventListener("click", function () {
    const root = document.documentElement;
    const now = root.dataset.theme || (dark.matches ? "dark" : "light");
    root.dataset.theme = now === "dark" ? "light" : "dark";
    retheme();
  });
  dark.addEventListener("change", retheme);
  // Paper is light: style knows, what scripts draw has to be told.
  let theme = "", closed = [];
  addEventListener("beforeprint", function () {
    closed = [...document.querySelectorAll("details:not([open])")];
    for (const details of closed) details.open = true;
    theme = document.documentElement.dataset.theme || "";
    document.documentElement.dataset.theme = "light";
    retheme();
  });
  addEventListener("afterprint", function () {
    for (const details of closed) details.open = false;
    if (theme) document.documentElement.dataset.theme = theme;
    else delete document.documentElement.dataset.theme;
    retheme();
  });

  // Pictures are drawn from the data, when they come into view: the page loads no image.
  const whenSeen = function (element, action) {
    let done = false;
    const once = function () {
      if (done) return;
      done = true;
      observer.disconnect();
      action();
    };
    const observer = new IntersectionObserver(
      (entries) => entries.some((entry) => entry.isIntersecting) && once(),
      { rootMargin: "400px" }
    );
    observer.observe(element);
    addEventListener("beforeprint", once);
  };
  for (const canvas of document.querySelectorAll("canvas[data-picture]")) {
    const draw = function () {
      const blob = new Blob([page.bytes(data.pictures[canvas.dataset.picture])]);
      createImageBitmap(blob).then(
        function (bitmap) {
          canvas.width = bitmap.width;
          canvas.height = bitmap.height;
          canvas.getContext("2d").drawImage(bitmap, 0, 0);
        },
        function () {
          canvas.remove();
        }
      );
    };
    whenSeen(canvas, draw);
  }

  page.chartOptions = function (xTitle, yTitle) {
    const axis = function (title) {
      return {
        title: { display: true, text: title, color: page.colour("quiet") },
        ticks: { color: page.colour("quiet"), maxRotation: 0, autoSkipPadding: 12 },
        grid: { color: page.colour("line"), borderColor: page.colour("line") },
      };
    };
    return {
      animation: false,
      responsive: true,
      maintainAspectRatio: false,
      interaction: { mode: "index", intersect: false },
      plugins: { legend: { labels: { color: page.colour("text"), boxWidth: 12 } } },
      scales: { x: axis(xTitle), y: axis(yTitle) },
    };
  };

  const timesCanvas = document.getElementById("times-chart");
  if (timesCanvas && data.times) {
    let chart = null;
    const draw = function () {
      if (chart) chart.destroy();
      const step = data.times.step_s;
      const first = Math.max(
        0,
        Math.min(...data.times.variants.map((variant) => variant.counts.findIndex((n) => n > 0)).filter((i) => i >= 0)) - 1
      );
      const bins = data.times.variants[0].counts.length;
      const labels = [];
      for (let i = first; i < bins; ++i) labels.push(String(i * step));
      const options = page.chartOptions("seconds", "attempts");
      options.scales.y.grace = "8%";
      options.plugins.tooltip = {
        callbacks: {
          title: (items) => items[0].label + " to " + (Number(items[0].label) + step) + " s",
        },
      };
      chart = new Chart(timesCanvas, {
        type: "bar",
        data: {
          labels: labels,
          datasets: data.times.variants.map(function (variant, i) {
            return {
              label: variant.name,
              data: variant.counts.slice(first),
              backgroundColor: page.colour("a" + (i % 6)),
              barPercentage: 1,
              categoryPercentage: 0.9,
            };
          }),
        },
        options: options,
      });
    };
    whenSeen(timesCanvas, function () {
      draw();
      page.onTheme.push(draw);
    });
  }

  if (data.cells && data.cells.length > 0 && document.getElementById("stage")) {
    whenSeen(document.getElementById("stage"), function () {
      page.startViewer(data);
    });
  }
})();
