"""Turns the shaders' text into C++ in which every number is a vector with one lane for each invocation.

Usage: vectorise.py OUTPUT FILE...    each FILE is read in turn; what they include is left out

`real`, `int`, `uint` and `bool` become classes of bench/text/vector_lanes.hpp, whose assignments spare the lanes that a
branch or loop leaves out. What C++ cannot overload is rewritten here: c ? a : b, returns from within branches, and loops whose
bounds differ from lane to lane. What indexes arrays stays a plain int: UNIFORM has its names, LIMITS the bounds of its loops.
"""
import re
import sys

UNIFORM = {"g", "number", "member"}
LIMITS = {"DOLP_GROUP", "masked_members()", "kTableOrder"}
TYPES = {"int": "Int", "uint": "Uint", "bool": "Mask"}


def matching(text, start, step):
    """The place of the bracket that closes (step 1) or opens (step -1) the one at `start`."""
    depth, place = 0, start
    while True:
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(text[place], 0)
        if depth == 0:
            return place
        place += step


def operand_start(text, place):
    """Where the condition before the ? at `place` begins."""
    place -= 1
    while True:
        letter = text[place]
        if letter in ")]":
            place = matching(text, place, -1)
        elif letter in "([{};,?:" or (letter == "=" and text[place - 1] not in "=<>!" and text[place + 1] != "="):
            return place + 1
        elif text[:place + 1].endswith("return") and not text[place + 1].isalnum():
            return place + 1
        place -= 1


def operand_end(text, place, ends):
    while text[place] not in ends:
        place = matching(text, place, 1) + 1 if text[place] in "([{" else place + 1
    return place


def select(text):
    """Without the ternary operator."""
    while "?" in text:
        mark = text.rindex("?")
        start = operand_start(text, mark)
        colon = operand_end(text, mark + 1, ":")
        end = operand_end(text, colon + 1, ");,:")
        text = (f"{text[:start]} select({text[start:mark].strip()}, {text[mark + 1:colon].strip()}, "
                f"{text[colon + 1:end].strip()}){text[end:]}")
    return text


def types(text):
    text = re.sub(r"\bCONST (real|int|uint)\b",
                  lambda m: "static constexpr " + {"real": "float", "int": "int", "uint": "std::uint32_t"}[m[1]], text)
    lines = []
    for line in text.split("\n"):
        if "static constexpr float" in line:
            line = line.replace("real(", "float(")
        elif "static constexpr" not in line:
            line = re.sub(r"\bfloat\(", "to_float(", line)
            line = re.sub(r"\b(int|uint)\(", r"to_\1(", line)
            line = re.sub(r"\b(int|uint|bool) (\w+)",
                          lambda m: m[0] if m[2] in UNIFORM or m[2] == "masked_members" else f"{TYPES[m[1]]} {m[2]}", line)
            line = re.sub(r"(\w+\.\w+)\[(to_int\([^\]]*\))\]", r"at(\1, \2)", line)
        lines.append(line)
    return "\n".join(lines)


def loops(text):
    def loop(match):
        name, limit = match[1], match[2]
        if limit in LIMITS:
            return f"for (int {name} = 0; {name} < {limit}; ++{name})"
        return f"for (Loop {name}({limit}); {name}.runs(); ++{name})"
    return re.sub(r"for \((?:Int|int) (\w+) = 0; \w+ < (.+?); \+\+\w+\)", loop, text)


def returns(text):
    """Functions with a return in a branch keep what they return until their end."""
    out, place = [], 0
    for match in re.finditer(r"^(\w+) (\w+)\([^;{]*?\) \{\n", text, re.M):
        if match.start() < place or match[1] == "struct":
            continue
        end = matching(text, match.end() - 2, 1)
        body = text[match.end():end]
        is_early = re.search(r"if \(.*\) return|^    +return", body, re.M) and match[1] != "int"
        if is_early:
            body = re.sub(r"if \((.*)\) return (.*?);",
                          r"{ auto is_early = (\1); IF (always(is_early)) return result_.whole(\2); "
                          r"if_ (is_early) result_.give(\2); IF (result_.is_over()) return result_.value(); }", body)
            body = re.sub(r"^    +return (.*?);", r"    result_.give(\1); IF (result_.is_over()) return result_.value();", body,
                          flags=re.M | re.S)
            body = re.sub(r"^  return (.*?);", r"  result_.give(\1);\n  return result_.value();", body, flags=re.M | re.S)
            body = f"  Result<{match[1]}> result_;\n" + body
        out += [text[place:match.end()], body]
        place = end
    return "".join(out) + text[place:]


def branches(text):
    text = re.sub(r"(?<!#)\belse\b", "else_", text)
    text = re.sub(r"\bif \(", "if_ (", text).replace("IF (", "if (").replace("else_ if_ (", "elif_ (")
    return text.replace("DOLP_WHERE(", "if_ (")


def transformed(text):
    text = re.sub(r"//.*", "", text)
    text = re.sub(r"^#(include|define DOLP_WHERE).*$", "", text, flags=re.M)
    return branches(returns(loops(types(select(text)))))


def main():
    with open(sys.argv[1], "w", encoding="utf-8") as output:
        for name in sys.argv[2:]:
            with open(name, encoding="utf-8") as file:
                output.write(transformed(file.read()))


main()
