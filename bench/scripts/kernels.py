#!/usr/bin/env python3
"""What the compiler of AMD's GPUs makes of the kernels: registers and spilled values. It needs no GPU: Mesa's driver
(package mesa-vulkan-drivers) compiles for a family of GPUs that the variable RADV_FORCE_FAMILY names.

kernels.py measure DOLP_BENCH RESULT.json   runs `dolp-bench kernels` for each of FAMILIES
kernels.py markdown RESULT.json             prints the table of bench/README.md
"""
import json
import os
import pathlib
import subprocess
import sys

# By product line. Mesa renamed the second family in 2023; at first Mesa let its kernels use only 128 of the 256 registers.
FAMILIES = {"RX 6000": ("navi21",), "RX 7000": ("navi31", "gfx1100")}
DRIVERS = pathlib.Path("/usr/share/vulkan/icd.d")


def measure(bench, family, *options):
    """The JSON of `dolp-bench kernels` for a family of GPUs; None if the driver does not know the family."""
    driver = next(DRIVERS.glob("radeon_icd*.json"), None)
    if driver is None:
        sys.exit(f"kernels.py: {DRIVERS} has no radeon_icd*.json; install mesa-vulkan-drivers")
    environment = os.environ | {"RADV_FORCE_FAMILY": family, "VK_DRIVER_FILES": str(driver), "VK_ICD_FILENAMES": str(driver)}
    done = subprocess.run([bench, "kernels", "--json", "-", "--quiet", *options], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if "Unknown family" in done.stderr:
        return None
    if done.returncode != 0:
        sys.exit(f"kernels.py: {bench} kernels, {family}: status {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def measured(bench):
    results = {}
    for name, families in FAMILIES.items():
        results[name] = next(filter(None, (measure(bench, family) for family in families)), None)
        if results[name] is None:
            sys.exit(f"kernels.py: the driver knows none of the families {', '.join(families)}")
    return {"study": "kernels", "context": results["RX 6000"]["context"],
            "results": {name: result["results"] for name, result in results.items()}}


def markdown(result):
    families = result["results"]
    statistics = {(name, row["case"], row["setting"]): row["statistics"] for name, rows in families.items() for row in rows}
    columns = [f"{name}: {what}" for name in families for what in ("registers", "waves", "spilled", "spilled in double")]
    print(f"Driver: {result['context']['device']['driver']}.\n")
    print("| kernel | " + " | ".join(columns) + " |\n" + "|---" * (len(columns) + 1) + "|")
    for kernel in dict.fromkeys(case for _, case, _ in statistics):
        cells = []
        for name in families:
            single, double = (statistics[name, kernel, setting] for setting in ("float", "double"))
            cells += [single["VGPRs"], single["Subgroups per SIMD"], single["Spilled VGPRs"], double["Spilled VGPRs"]]
        print(f"| {kernel} | " + " | ".join(f"{cell:g}" for cell in cells) + " |")


def main():
    if sys.argv[1] == "measure":
        pathlib.Path(sys.argv[3]).write_text(json.dumps(measured(sys.argv[2]), indent=1) + "\n", encoding="utf-8")
    else:
        markdown(json.loads(pathlib.Path(sys.argv[2]).read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
