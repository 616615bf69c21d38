"""Grazes at which several impacts vanish at once: kind and direction are those of the simpler orbit that is left."""

import numpy as np

import vibro_sweep as vs

CAVITY = vs.Oscillator.named(
    "ball_in_cavity", mass_ratio=0.32390854690596516, zeta=0.03714403694893168, F=0.23152842665138668,
    omega=1.8613084852956212, R=0.6833793858566803, b=0.09457563286763157, tau=4.730451729828434,
)  # fmt: skip


def test_a_ball_loses_its_three_impacts_at_once():
    """What is left is the free motion, whose mean may be anything: no slopes by its equations alone."""
    guess = [
        (3.334624821473895, -1, -0.0008378634933353772), (5.024582905460395, 1, 0.0004937750792930118),
        (8.399255574159506, 1, 0.0003440884140426629),
    ]  # fmt: skip
    orbit = vs.periodic_orbit(CAVITY, guess=guess, periods=3)
    branch = vs.continue_orbit(orbit, "omega", (1.302915939706935, 2.4197010308843074))
    assert (branch.begins.type, branch.begins.direction) == ("graze", 1)
    assert np.abs(branch.begins.orbit.impacts["v1"]).max() < 1e-12
    assert branch.ok


TWO = vs.Oscillator(
    M=[[1.1414369067006915, 0.15046100578757718], [0.15046100578757718, 1.8805340529414454]],
    K=[[0.3839405346473024, -0.15376145029531613], [-0.15376145029531613, 4.733794369080081]],
    C=[[0.012593363756930615, -0.003352194065001478], [-0.003352194065001478, 0.014400586563905905]],
    contact_normal=[0.12595535078005846, -0.3894036885875713], force=[0.10141323480012705, 0.3760191746430947],
    force_cos=[0.19710242471759157, -0.33874244460319325], omega=1.650794746199226, R=0.6258383008466413,
    b=0.21943401440354907, offset=0.011679962720832002, tau=1.2020914701772594,
)  # fmt: skip
U = [
    4.556139396633535,
    10.686931356485823,
    12.17216711202304,
    17.9455360363212,
    23.585527529756824,
    29.75679354787549,
    31.214733376841927,
    36.96901645220432,
    42.627241141855286,
    48.76640953520879,
    50.19722366436468,
    56.20486600155018,
    61.70404071881555,
    69.2599403711939,
    75.03608825479586,
    0.5372319463505559,
    -0.04748295847969935,
    0.6508619142650444,
    -0.17769683824793375,
    0.5341260084860262,
    -0.015138381392024475,
    0.6828800895145256,
    -0.16639607613427276,
    0.5328906783618748,
    -0.03142656550264324,
    0.7046663675947167,
    -0.039066451678740705,
    0.6645137884774661,
    0.6761012922850016,
    -0.15728803077351583,
]


def test_an_orbit_grazes_where_a_simpler_one_does():
    """Three of 15 impacts vanish at once, of an orbit of period 20, at the graze of one of period 5 with 4 impacts."""
    guess = [(t, -1 if D > 0 else 1, -D / (1 + TWO.R)) for t, D in zip(U[:15], U[15:], strict=True)]
    orbit = vs.periodic_orbit(TWO, guess=guess, periods=20)
    assert orbit.itinerary == "LLRLRLRLRLRLRLR"
    end = vs.continue_orbit(orbit, "offset", (0.0116, 0.0126)).ends
    assert (end.type, end.kind, end.direction) == ("graze", "persistence", 1)
    assert np.count_nonzero(np.abs(end.orbit.impacts["v1"]) < 1e-11) == 3
    (simpler,) = vs.switch(end)
    assert (simpler.period, len(simpler.impacts)) == (5, 3)
