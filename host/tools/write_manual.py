#!/usr/bin/env python3
"""Rewrites the generated parts of the manual.

Usage: write_manual.py [--check] [--build FOLDER] [FILE.md...]
A part lies between the lines <!-- generated: COMMAND --> and <!-- end of generated -->. It becomes the output of
COMMAND, run in the repository's root, in all Markdown files of the repository, or only in the named files.
With --build, FOLDER replaces build/release/ at the beginning of words of COMMAND. --check only names outdated parts.
Exit status: 0 done or nothing outdated, 1 --check found an outdated part, 2 a command fails or a mark has no end.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = "build/release/"
PART = re.compile(r"<!-- generated: (.+?) -->\n(.*?)<!-- end of generated -->", re.DOTALL)


class CannotGenerate(Exception):
    """A command failed, or a part has no line `end of generated`."""


def markdown_files():
    return sorted(path for path in ROOT.rglob("*.md")
                  if not any(part == "build" or part.startswith(".") for part in path.relative_to(ROOT).parts))


def output_of(command, build):
    words = [str(build / word[len(BUILD):]) if word.startswith(BUILD) else word for word in shlex.split(command)]
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    except OSError as error:
        raise CannotGenerate(f"{command}: {error}") from error
    if done.returncode != 0:
        raise CannotGenerate(f"{command}: exit status {done.returncode}: {done.stderr.strip()}")
    return "\n" + done.stdout.strip("\n") + "\n\n"


def regenerated(text, build):
    """The text with all generated parts up to date, and the commands of the parts that were outdated."""
    if text.count("<!-- generated: ") != len(PART.findall(text)):
        raise CannotGenerate("a mark <!-- generated: COMMAND --> has no <!-- end of generated -->")
    stale = []

    def current(part):
        command, old = part.group(1), part.group(2)
        new = output_of(command, build)
        if new != old:
            stale.append(command)
        return f"<!-- generated: {command} -->\n{new}<!-- end of generated -->"

    return PART.sub(current, text), stale


def main():
    parser = argparse.ArgumentParser(prog="write_manual.py", description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / BUILD, metavar="FOLDER")
    parser.add_argument("files", nargs="*", type=pathlib.Path, metavar="FILE.md")
    options = parser.parse_args()
    is_current = True
    for path in options.files or markdown_files():
        try:
            text, stale = regenerated(path.read_text(encoding="utf-8"), options.build.resolve())
        except CannotGenerate as error:
            print(f"write_manual.py: {path}: {error}", file=sys.stderr)
            return 2
        for command in stale:
            print(f"{path}: {'not current' if options.check else 'rewritten'}: {command}")
        is_current = is_current and not stale
        if stale and not options.check:
            path.write_text(text, encoding="utf-8")
    return 1 if options.check and not is_current else 0


if __name__ == "__main__":
    sys.exit(main())
