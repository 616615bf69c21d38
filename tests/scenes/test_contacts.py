"""Contacts as a list: an oscillator with several can be made, printed and saved; all that computes refuses it."""

import copy
import pickle

import numpy as np
import pytest

import vibro_sweep as vs

MATRICES = {"M": [[1, 0], [0, 2]], "K": [[2, -1], [-1, 1]], "force": [1, 0], "omega": 0.8}
WALL, BETWEEN = vs.Contact([1, 0], b=1.0, R=0.8), vs.Contact([-1, 1], b=0.2, stops="right", k_stop=100.0, c_stop=1.0)
SEVERAL = vs.Oscillator(**MATRICES, contacts=[WALL, BETWEEN])
CHAIN = {"m": [1, 2], "k": [1, 1, 1], "force": [1, 0], "omega": 0.8, "R": 0.5, "b": 0.7, "stop_at": 2}


@pytest.mark.parametrize("contact", [WALL, BETWEEN, vars(BETWEEN)], ids=["rigid", "compliant", "mapping"])
def test_a_list_of_one_is_what_is_said_without_a_list(contact):
    given = vars(contact) if isinstance(contact, vs.Contact) else contact
    assert vs.Oscillator(**MATRICES, contacts=[contact]) == vs.Oscillator(**MATRICES, **given)


def test_several_are_printed_and_saved():
    assert SEVERAL.contacts == (WALL, BETWEEN) and SEVERAL.masses == 2
    for same in (
        eval(repr(SEVERAL), vars(vs) | {"Oscillator": vs.Oscillator, "Contact": vs.Contact}),
        pickle.loads(pickle.dumps(SEVERAL)),
        copy.deepcopy(SEVERAL),
        SEVERAL.replace(omega=0.9).replace(omega=0.8),
        vs.Oscillator.named("linear", **MATRICES, contacts=[vars(WALL), BETWEEN]),
    ):
        assert same == SEVERAL and hash(same) == hash(SEVERAL)
    assert SEVERAL != vs.Oscillator(**MATRICES, contacts=[BETWEEN, WALL])
    assert SEVERAL != vs.Oscillator(**MATRICES, contacts=[WALL])


def test_every_model_takes_further_ones():
    chain = vs.Oscillator.named("chain", **CHAIN, contacts=[BETWEEN])
    assert chain.contacts == (vs.Contact([0, 1], b=0.7, R=0.5), BETWEEN) and "contacts=[Contact((-1.0" in repr(chain)
    assert vs.Oscillator.named("chain", **CHAIN).contacts == chain.contacts[:1]


@pytest.mark.parametrize(
    "compute",
    [
        lambda: vs.simulate(SEVERAL, np.zeros(4), 1),
        lambda: vs.lyapunov(SEVERAL, np.zeros(4)),
        lambda: vs.sweep(SEVERAL, {"b": [1, 2]}),
        lambda: vs.sweep(lambda b: SEVERAL.replace(b=b), {"b": [1, 2]}),
        lambda: vs.periodic_orbit(SEVERAL, itinerary="R"),
        lambda: vs.born_at_grazing(SEVERAL),
        lambda: vs.grazing(SEVERAL),
        lambda: vs.discontinuity_map(SEVERAL),
        lambda: vs.explore(SEVERAL, "b"),
        lambda: SEVERAL.linear,
        lambda: SEVERAL.phase,
    ],
)
def test_what_computes_refuses_several_in_one_sentence(compute):
    with pytest.raises(vs.VibroSweepError, match=r"^system: it has 2 contacts; those with one are computed; docs/"):
        compute()


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: vs.Oscillator(**MATRICES), "contact_normal: None"),
        (lambda: vs.Oscillator(**MATRICES, contacts=[]), "a list of one Contact or more"),
        (lambda: vs.Oscillator(**MATRICES, contacts=[{"b": 1}]), r"contacts\[0\]: .* a Contact, or its contact_normal"),
        (lambda: vs.Oscillator(**MATRICES, R=0.5, contacts=[WALL]), "R: 0.5 .* left out where `contacts` are given"),
        (lambda: vs.Oscillator(**MATRICES, contacts=[WALL, vs.Contact([1], b=1, R=1)]), "contact_normal of contact 2"),
        (lambda: vs.Contact([0, 0], b=1, R=1), "other than zero"),
        (lambda: vs.Contact([1], b=-1, R=1), "b: -1"),
        (lambda: vs.Contact([1], b=1), "R: None"),
        (lambda: vs.Contact([1], b=1, R=1, stops="none"), "stops: 'none' .* both, right or left"),
    ],
)
def test_what_is_no_contact_is_refused(make, words):
    with pytest.raises(vs.ParameterError, match=words):
        make()
