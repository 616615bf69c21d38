// Files that the browser keeps: scene, program, picture, data.

const FILES = { yaml: "explored.yaml", python: "explored.py", hdf5: "explored.h5", png: "explored.png", svg: "explored.svg" };

export async function saveAs(message, state) {
  if (message.form === "link") {
    await navigator.clipboard.writeText(location.origin + location.pathname + state.fragment());
    return "Copied. The link has no token: who opens it adds the ?token=... of a running program before the #.";
  }
  if (message.form === "png") return message.canvas.toBlob((blob) => download(blob, FILES.png));
  const content = message.arrays?.data ?? message.text;
  return download(new Blob([content]), FILES[message.form]);
}

function download(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
