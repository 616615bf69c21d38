// What the browser keeps: the scene and the picture as files, the link in the clipboard.

export async function copyLink(state) {
  await navigator.clipboard.writeText(location.origin + location.pathname + state.fragment());
  return "Copied. The link has no token: who opens it adds the ?token=... of a running program before the #.";
}

export function keep(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
