"""Who may talk to the server: pages of this machine that know the token, and no other site that is open beside them."""

import secrets
from urllib.parse import parse_qs, urlsplit

from starlette.types import Scope

HOSTS = ("127.0.0.1", "localhost")
HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; "
        "base-uri 'none'; form-action 'none'; frame-ancestors http://127.0.0.1:* http://localhost:*"  # notebooks
    ),
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}


def new_token() -> str:
    """A token that nobody guesses."""
    return secrets.token_urlsafe(24)


def host_is_here(scope: Scope) -> bool:
    """Whether a request names this machine, by whatever port: so it comes from a page of ours, also through a tunnel.

    A name of another site that points to this machine is refused.
    """
    return _name(_header(scope, b"host")) in HOSTS


def origin_is_foreign(scope: Scope) -> bool:
    """Whether a request says that a page of another site makes it. Most requests of our own say nothing."""
    return any(key == b"origin" for key, _ in scope["headers"]) and not origin_is_here(scope)


def origin_is_here(scope: Scope) -> bool:
    """Whether a request says that it comes from a page of the same address, as one for a socket has to."""
    host, origin = _header(scope, b"host"), _header(scope, b"origin")
    return origin in (f"http://{host}", f"https://{host}")


def knows_token(scope: Scope, token: str) -> bool:
    """Whether the query has the token; compared in a time that says nothing of it."""
    sent = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
    return secrets.compare_digest(sent.encode(), token.encode())


def _header(scope: Scope, name: bytes) -> str:
    values = [value for key, value in scope["headers"] if key == name]
    return values[0].decode("latin-1") if len(values) == 1 else ""


def _name(host: str) -> str | None:
    try:
        parts = urlsplit(f"//{host}")
        return parts.hostname if parts.port is None or parts.port > 0 else None
    except ValueError:
        return None
