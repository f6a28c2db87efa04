#!/usr/bin/env python3
"""gpu_kernels_test.py DOLP_BENCH SCRIPTS: AMD's compiler keeps all values of the float kernels in registers."""
import sys

sys.path.insert(0, sys.argv[2])
import kernels

LEAST_KERNELS = 19
FOR_PROCESSORS = "rows of four"  # GPUs run no kernels of this kind


def main():
    result = kernels.measure(sys.argv[1], "navi21", "--case", "float")
    rows = [row for row in result["results"] if not row["case"].startswith(FOR_PROCESSORS)]
    assert len(rows) >= LEAST_KERNELS, f"only {len(rows)} kernels"
    spilled = {row["case"]: row["statistics"]["Spilled VGPRs"] for row in rows if row["statistics"]["Spilled VGPRs"] > 0}
    assert not spilled, f"kernels spill on navi21: {spilled}; `dolp-bench kernels` has the statistics"


main()
