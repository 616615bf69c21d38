"""How a point went: numerical outcomes travel with the data, as codes with a meaning."""

NOT_COMPUTED = -1
OK = 0
EVENT_LIMIT = 1
NOT_FINITE = 2
TOO_STIFF = 3
UNRESOLVED = 4

MEANINGS = {
    NOT_COMPUTED: "not_computed",
    OK: "ok",
    EVENT_LIMIT: "too_many_impacts_in_a_period",
    NOT_FINITE: "not_finite",
    TOO_STIFF: "rates_too_far_apart",
    UNRESOLVED: "contact_unresolved",
}
