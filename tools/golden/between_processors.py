"""Cases whose numbers depend on the processor by more than ten times what a move of some of the inputs does.

Up to three masses all cases were computed for a processor without AVX-512 (NUMBA_CPU_NAME=haswell,
NUMBA_CPU_FEATURES= and OPENBLAS_CORETYPE=Haswell), where nothing differed, and without fused multiply-adds as well
(NUMBA_CPU_FEATURES=-fma), where these did. `python -m tools.golden check` compares so; kernels of another processor
need a NUMBA_CACHE_DIR of their own.
"""

FUSED = "without fused multiply-adds they lie up to 1e-11 of their size elsewhere"

WIDER = {  # kind and name of a case -> why its numbers may lie 1e-9 of their size from the record
    "exponents: three masses, compliant, 5": FUSED,
    "maps: three masses, rigid, 17": FUSED,
    "maps: three masses, rigid, 18": FUSED,
}
