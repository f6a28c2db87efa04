#!/usr/bin/env python3
"""Prints a Markdown table with the date and the machine of each study. Usage: machines.py RESULT.json..."""
import json
import sys


def row(path):
    with open(path, encoding="utf-8") as file:
        result = json.load(file)
    context = result["context"]
    machine, device = context["machine"], context["device"]
    processor = [machine["processor"], f"{machine['cores']} cores", machine.get("vector_instructions")]
    return [result["study"], context["date"][:10], context["program"], ", ".join(filter(None, processor)),
            f"{machine['load']:.1f}", f"{device.get('name', 'none')}, {device.get('driver', '')}", machine["system"]]


def main():
    print("| study | date | program | processor | load before | device | system |\n" + "|---" * 7 + "|")
    for path in sys.argv[1:]:
        print("| " + " | ".join(row(path)) + " |")


if __name__ == "__main__":
    main()
