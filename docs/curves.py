"""Draws docs/curves.png: python docs/curves.py"""

import vibro_sweep as vs

NAMES, BOX = ("b", "omega"), ((1, 9), (0.5, 0.75))


def main() -> None:
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2)
    curves, followed = [], []
    for itinerary in ("LR", "R"):
        orbit = vs.periodic_orbit(system.replace(b=4.0), itinerary=itinerary)
        branch = vs.continue_orbit(orbit, "b", (1, 6.8))
        for special in branch.special:
            if special.type in ("pitchfork", "neimark_sacker", "graze"):
                curves.append(vs.bifurcation_curve(special, NAMES, BOX))
    for curve in tuple(curves):
        for special in curve.special:
            if special.type in ("fold_flip", "fold_neimark_sacker", "resonance_1_2"):
                for start in vs.switch(special):
                    known = start.type, start.orbit.itinerary
                    if start.type in ("fold", "flip") and known not in followed:
                        followed.append(known)
                        curves.append(vs.bifurcation_curve(start, NAMES, BOX))
    curves[0].plot(*curves[1:]).savefig("docs/curves.png")


if __name__ == "__main__":
    main()
