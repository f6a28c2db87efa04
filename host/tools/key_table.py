#!/usr/bin/env python3
"""Prints the keys of scenes as a Markdown table. Usage: key_table.py DOLP, where DOLP is the path of the program."""
import json
import subprocess
import sys

SHORTER = {"a number in ": "", "two ascending numbers in ": "two of ", "a list of pairs of ascending numbers in ": "pairs in ",
           "a text, or a list of ": "", "a ": ""}


def code(text):
    return f"`{text}`" if text else "—"


def values(allowed):
    if "{ from" in allowed:
        return "axis in " + allowed.removeprefix("a number in ").split(", a list")[0]
    for begin, word in SHORTER.items():
        if allowed.startswith(begin):
            return word + allowed.removeprefix(begin)
    return ", ".join(code(word.strip('"')) for word in allowed.removeprefix("one of ").replace(" or ", ", ").split(", "))


def main():
    printed = subprocess.run([sys.argv[1], "keys", "--json"], capture_output=True, text=True, check=True).stdout
    print("| key | unit | values | default | meaning |\n|---|---|---|---|---|")
    for key in json.loads(printed)["keys"]:
        default = key["default"] if key["default"] == "required" else code(key["default"])
        print(f"| `{key['key']}` | {key['unit']} | {values(key['allowed'])} | {default} | {key['meaning']} |")


if __name__ == "__main__":
    main()
