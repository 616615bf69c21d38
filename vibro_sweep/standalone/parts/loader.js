// What a page's file begins with: its parts are unpacked, and its script is run. In words of 2015, so that an older
// browser reads what it cannot do.
(function () {
  var known = typeof WebAssembly === "object" && typeof DecompressionStream === "function" && Array.prototype.findLastIndex;
  function say(words) {
    var status = document.getElementById("status");
    status.textContent = words;
    status.className = "bad";
    document.documentElement.setAttribute("data-state", "final");
  }
  if (!known) return say("This page needs a browser of 2023 or later: Chromium 103, Firefox 113, Safari 16.4.");
  function unpacked(name) {
    var text = atob(document.getElementById(name).textContent), bytes = new Uint8Array(text.length);
    for (var i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }
  Promise.all([unpacked("page").json(), unpacked("main").text(), unpacked("worker").blob()]).then(function (found) {
    var worker = new Blob([found[2]], { type: "text/javascript" }), script = document.createElement("script");
    window.standalone = { page: found[0], worker: URL.createObjectURL(worker), module: unpacked("module").arrayBuffer() };
    script.textContent = found[1];
    document.body.append(script);
  }).catch(function (error) {
    say("This file is damaged: " + error.message);
  });
})();
