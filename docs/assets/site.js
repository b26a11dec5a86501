// Equations: Markdown leaves them as \(...\) and \[...\]; KaTeX, which comes with the site, sets them.
document.addEventListener("DOMContentLoaded", () => {
  renderMathInElement(document.body, {
    delimiters: [
      {left: "\\[", right: "\\]", display: true},
      {left: "\\(", right: "\\)", display: false},
    ],
    throwOnError: false,
  });
});
