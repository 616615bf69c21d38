"""docs/reference/glossary.md: terms, each once and in order; words of the program are on the pages that it makes."""

import re

from support import ROOT

TEXT = (ROOT / "docs" / "reference" / "glossary.md").read_text()


def test_a_term_has_one_meaning():
    terms = re.findall(r"^\| ([a-zA-Z].*?) \|", TEXT, re.M)[1:]
    assert terms == sorted(terms, key=str.lower) and len(terms) == len({*terms}) > 25
