// First on the page: records all errors.
window.wrong = [];
window.addEventListener("error", function (e) { window.wrong.push("error: " + (e.message || e.target)); }, true);
window.addEventListener("unhandledrejection", function (e) { window.wrong.push("rejection: " + e.reason); });
document.addEventListener("securitypolicyviolation", function (e) {
  window.wrong.push("request: " + e.violatedDirective + " " + e.blockedURI);
});
["error", "warn", "assert"].forEach(function (kind) {
  console[kind] = function () { window.wrong.push(kind + ": " + Array.from(arguments).join(" ")); };
});
