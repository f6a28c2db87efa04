#!/usr/bin/env python3
"""Tests the manual: its commands work, its generated parts are current, and its links have targets.

Usage: manual_test.py BUILD [TEST...]    BUILD is the folder that has dolp; ctest runs each test separately
The test runs the blocks ```sh and ```python of FILES_WITH_COMMANDS unchanged and in order. It skips blocks that
contain a key of NOT_RUN. The blocks of a file run in a new folder with host, bench and what quickstart.sh builds. If a
block ```text follows a block directly, it is what the block prints, where "…" stands for any text.
"""
import csv
import functools
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.dont_write_bytecode = True  # no cache folders in the sources

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path("build/release")
FILES_WITH_COMMANDS = ("README.md", "host/programs/cli/README.md", "host/lib/fit/README.md", "host/core/scene/README.md")
BLOCK_TIMEOUT_S = 300  # for a sanitizer build on two busy cores; in a release build a block takes seconds

# A block that contains one of these keys does not run. The value of the key is the reason.
NOT_RUN = {
    "quickstart.sh": "builds the program",
    "tests/run.sh": "runs this test",
    "dolp explore": "needs a display; explore_window_test covers it",
    "export PATH": "has no effect beyond its own shell; the test sets PATH and PYTHONPATH likewise",
}

# Is appended to the Python code of RESPONSE_MANUAL. Prints rho_i and rho_q of all entries in one line. Then prints for
# each entry a line with the three arrays that the GLSL function of RESPONSE_MANUAL takes. RHO_IN_CPP reads these lines.
RESPONSE_MANUAL = "host/programs/cli/README.md"
PRINT_RHO = """
print(*np.stack([rho_i, rho_q], axis=-1).ravel())
for w, v in zip(table.response_i.values.reshape(-1, 24), table.response_q.values.reshape(-1, 24)):
    print(*c.values, *w, *v)
"""
RHO_IN_CPP = """#include <cstdio>
#include <glm/glm.hpp>
using namespace glm;
{glsl}
int main() {{
  float numbers[3][24];
  for (int i = 0; std::scanf("%f", &numbers[0][0] + i) == 1; i = (i + 1) % 72) {{
    if (i < 71) continue;
    const vec2 r = rho(1.33f, 0.05f, numbers[0], numbers[1], numbers[2]);
    std::printf("%.9g %.9g\\n", r.x, r.y);
  }}
}}
"""

RUN_BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$(?:\n```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)
SHELLS = {"sh": ("bash", "-eu", "-c"), "python": ("/usr/bin/python3", "-c")}
ANY_BLOCK = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(r"^ *(build/release/)?dolp (table|response|eval|mueller|plan|verify|lookup|fit|materials|devices|explore)\b", re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)


def markdown_files():
    return sorted(path for path in ROOT.rglob("*.md")
                  if not any(part == "build" or part.startswith(".") for part in path.relative_to(ROOT).parts))


def anchors(text):
    """The anchors that GitHub makes from the headings of a Markdown file."""
    names = (re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()) for heading in HEADING.findall(text))
    return {name.strip().replace(" ", "-") for name in names}


def blocks_of(name):
    return RUN_BLOCK.findall((ROOT / name).read_text(encoding="utf-8"))


def words_of_commands(*targets):
    """The words in the commands that build the targets, or in all commands of the build if there are no targets."""
    done = subprocess.run(["ninja", "-C", BUILD_FOLDER, "-t", "commands", *targets], check=True, text=True,
                          stdout=subprocess.PIPE)
    return set(done.stdout.split())


def words_of_quickstart():
    quickstart = (ROOT / "host/quickstart.sh").read_text(encoding="utf-8")
    return words_of_commands(*re.search(r"--target (.*)", quickstart)[1].split())


class Manual(unittest.TestCase):
    def test_commands_run(self):
        built = words_of_quickstart()
        for name in FILES_WITH_COMMANDS:
            with tempfile.TemporaryDirectory() as folder:
                self.run_blocks(name, pathlib.Path(folder), built)

    def run_blocks(self, name, folder, built):
        for source in ("host", "bench"):
            (folder / source).symlink_to(ROOT / source)
        (folder / BUILD).mkdir(parents=True)
        for entry in BUILD_FOLDER.iterdir():
            is_program = entry.is_file() and os.access(entry, os.X_OK)
            if not is_program or entry.name in built:
                (folder / BUILD / entry.name).symlink_to(entry)
        environment = dict(os.environ, PATH=f"{folder / BUILD}:{os.environ['PATH']}", PYTHONDONTWRITEBYTECODE="1",
                           PYTHONPATH=str(folder / BUILD / "python"), MPLBACKEND="Agg")
        blocks = blocks_of(name)
        self.assertTrue(blocks, f"{name} has no command")
        for shell, block, printed in blocks:
            if any(text in block for text in NOT_RUN):
                continue
            with self.subTest(file=name, block=block):
                done = subprocess.run([*SHELLS[shell], block], cwd=folder, env=environment, text=True, check=False,
                                      stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                      timeout=BLOCK_TIMEOUT_S)
                self.assertEqual(done.returncode, 0, done.stdout)
                if printed:
                    self.assertRegex(done.stdout, "^" + re.escape(printed).replace("…", ".*") + "$")

    def test_response_functions_give_what_tables_hold(self):
        """RESPONSE_MANUAL has Python and GLSL code that computes rho_i and rho_q from a response table."""
        text = (ROOT / RESPONSE_MANUAL).read_text(encoding="utf-8")
        python, = [block for _, block, _ in RUN_BLOCK.findall(text) if "response.nc" in block and "import" in block]
        glsl, = re.findall(r"^```glsl\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertLessEqual(glsl.count("\n"), 10)
        with tempfile.TemporaryDirectory() as folder:
            run = functools.partial(subprocess.run, cwd=folder, check=True, text=True, stdout=subprocess.PIPE)
            scene = [ROOT / "host/scenes/night_paint.toml", "--quiet", "--evaluator", "cpu", "--set", "surface.n=1.33", "--set",
                     "surface.k=0.05", "--set", "surface.specular=1", "--set", "surface.diffuse=0", "--set", "grid.theta_deg=[0,60,85]"]
            run([BUILD_FOLDER / "dolp", "response", *scene, "-o", "response.nc"])
            run([BUILD_FOLDER / "dolp", "table", *scene, "--keep-all", "-o", "table.csv"])
            (pathlib.Path(folder) / "python.py").write_text(python + PRINT_RHO, encoding="utf-8")
            done = run(["/usr/bin/python3", "python.py"]).stdout.split("\n", 1)
            shader = f"#version 450\n{glsl}\nvoid main() {{ float c[24]; vec2 r = rho(1.0, 0.0, c, c, c); }}\n"
            run(["glslangValidator", "--stdin", "-S", "comp"], input=shader)
            (pathlib.Path(folder) / "rho.cpp").write_text(RHO_IN_CPP.format(glsl=glsl), encoding="utf-8")
            run(["c++", "-fsingle-precision-constant", "-o", "rho", "rho.cpp"])
            from_glsl = run(["./rho"], input=done[1]).stdout.split()
            with open(pathlib.Path(folder) / "table.csv", encoding="utf-8") as file:
                rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        from_table = [float(row[name]) for row in rows for name in ("rho_i", "rho_q")]
        for found in (done[0].split(), from_glsl):
            self.assertEqual(len(found), len(from_table))
            for value, expected in zip(found, from_table):
                self.assertAlmostEqual(float(value), expected, delta=2e-5)

    def test_quickstart_builds_what_is_installed(self):
        """README runs quickstart.sh and then cmake --install, which fails if quickstart.sh has not built all files."""
        built, everything = words_of_quickstart(), words_of_commands()
        checked = 0
        for script in BUILD_FOLDER.rglob("cmake_install.cmake"):
            for file in re.findall(f'"({re.escape(str(BUILD_FOLDER))}/[^"]+)"', script.read_text(encoding="utf-8")):
                names = {file, str(pathlib.Path(file).relative_to(BUILD_FOLDER))}
                if names & everything:  # false for files that no command of the build makes
                    self.assertTrue(names & built, f"{file} is installed, and quickstart.sh does not build it")
                    checked += 1
        self.assertGreater(checked, 5)

    def test_commands_are_in_blocks_that_run(self):
        for name in FILES_WITH_COMMANDS:
            text = (ROOT / name).read_text(encoding="utf-8")
            others = [block for block in ANY_BLOCK.findall(text) if not block.startswith("```sh\n")]
            others.append(ANY_BLOCK.sub("", text))
            for other in others:
                found = COMMAND.search(other) if not other.startswith("```bash") else None
                self.assertIsNone(found, f"{name}: a command outside of a block marked ```sh: {found}")

    def test_reasons_are_needed(self):
        blocks = [block for name in FILES_WITH_COMMANDS for _, block, _ in blocks_of(name)]
        for part in NOT_RUN:
            self.assertTrue(any(part in block for block in blocks), f"no block contains {part}")

    def test_generated_parts_are_current(self):
        done = subprocess.run([sys.executable, ROOT / "host/tools/write_manual.py", "--check", "--build", BUILD_FOLDER],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + "host/tools/write_manual.py rewrites them")

    def test_links_resolve(self):
        for path in markdown_files():
            text = path.read_text(encoding="utf-8")
            for link in LINK.findall(ANY_BLOCK.sub("", text)):
                if re.match(r"[a-z]+:", link):
                    continue
                file_name, _, anchor = link.partition("#")
                target = (path.parent / file_name).resolve() if file_name else path
                with self.subTest(file=str(path.relative_to(ROOT)), link=link):
                    self.assertTrue(target.exists(), "leads nowhere")
                    if anchor:
                        self.assertIn(anchor, anchors(target.read_text(encoding="utf-8")))

    def test_workflow_runs_the_commands_of_the_readme(self):
        workflow = yaml.safe_load((ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8"))
        commands = [step["run"] for step in workflow["jobs"]["readme"]["steps"] if "run" in step]
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        self.assertEqual(commands, ["bash host/quickstart.sh", "bash tests/run.sh"])
        for command in commands:
            self.assertIn(f"\n{command} ", readme)


if __name__ == "__main__":
    BUILD_FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
