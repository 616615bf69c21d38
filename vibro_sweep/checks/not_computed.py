"""What users ask for and no model has: a refusal says so, by the name that they give it."""

PAGE = "docs/start/your_machine.md says what is"
NAMES = {
    "dry friction is not computed": ("friction", "mu_f", "mu_s", "mu_d", "coulomb"),
    "springs are linear, others are not computed": ("k3", "k_3", "k_cubic", "cubic", "knl", "k_nl", "duffing"),
    "springs and stops are linear, others are not computed": ("exponent", "hertz", "power", "n_hertz"),
    "dampers are linear, drag is not computed": ("drag", "quadratic", "c_quadratic"),
    "there is one contact, several are not computed": ("contacts", "gaps", "clearances", "normals", "contact_normals"),
    "the force has one frequency, several are not computed": ("omegas", "omega2", "omega_2", "frequencies"),
    "gyroscopic forces are not computed": ("G", "gyro", "gyroscopic"),
}
_SENTENCES = {name: sentence for sentence, names in NAMES.items() for name in names}


def why_not_computed(name: str) -> str | None:
    """The sentence on what a name stands for; None where it may be a slip."""
    sentence = _SENTENCES.get(name) or _SENTENCES.get(name.lower())
    return sentence and f"{sentence}; {PAGE}"
