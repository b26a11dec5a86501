// Equations: Markdown leaves them as \(...\) and \[...\]; KaTeX, which comes with the site, sets them.
document.addEventListener("DOMContentLoaded", () => {
  for (const table of document.querySelectorAll("table"))  // of an experiment file's keys: site.css
    if (table.querySelector("th")?.textContent === "key") table.dataset.keys = "";
  renderMathInElement(document.body, {
    delimiters: [
      {left: "\\[", right: "\\]", display: true},
      {left: "\\(", right: "\\)", display: false},
    ],
    throwOnError: false,
  });
});
