#!/usr/bin/env python3
"""Turns the plain `//` comments of a header into Doxygen comments.

usage: doxygen_filter.py HEADER

Prints the header with the same number of lines, so that Doxygen's warnings name the right line:

- The comment at the top of the file becomes the description of the file.
- A comment block directly before a declaration becomes its description (`///`).
- A comment after a member or enumerator becomes its description (`///<`), with the lines below that continue it at
  the same column.

Comments inside function bodies, before preprocessor lines, before a closing brace, and blocks followed by an empty line
remain plain comments. Characters with a meaning in Doxygen are escaped; comments that already begin with `///` or
`//!` pass unchanged.
"""

import re
import sys

SCOPE_WORDS = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")


def escape(text):
    """Returns the text of a comment such that Doxygen takes it literally, but for Markdown."""
    parts = text.split("`")
    for n in range(0, len(parts), 2):  # outside of `code`
        parts[n] = re.sub(r"([\\@<>#&%$])", r"\\\1", parts[n])
    if len(parts) % 2 == 0:  # an odd number of backticks: none of them delimits code
        return re.sub(r"([\\@<>#&%$`])", r"\\\1", text)
    return "`".join(parts)


def split_line(line, state):
    """Returns (code, column of the // comment or None); strings are blanked in the code."""
    code = []
    n = 0
    while n < len(line):
        if state["block"]:
            end = line.find("*/", n)
            if end < 0:
                return "".join(code), None
            state["block"] = False
            n = end + 2
            continue
        if state["raw"] is not None:
            end = line.find(state["raw"], n)
            if end < 0:
                return "".join(code), None
            n = end + len(state["raw"])
            state["raw"] = None
            continue
        rest = line[n:]
        if rest.startswith("//"):
            return "".join(code), n
        if rest.startswith("/*"):
            state["block"] = True
            n += 2
            continue
        raw = re.match(r'R"([^()\\ ]{0,16})\(', rest)
        if raw:
            state["raw"] = ")" + raw.group(1) + '"'
            n += raw.end()
            code.append('""')
            continue
        # A quote between digits (1'000) separates them and begins no character.
        if rest[0] == '"' or (rest[0] == "'" and not (n > 0 and line[n - 1].isalnum())):
            quote = rest[0]
            end = 1
            while end < len(rest) and rest[end] != quote:
                end += 2 if rest[end] == "\\" else 1
            code.append('""')
            n += end + 1
            continue
        code.append(rest[0])
        n += 1
    return "".join(code), None


class Scopes:
    """Follows braces: whether a line stands where declarations stand, or inside a function or an initialiser."""

    def __init__(self):
        self.stack = []  # True for a scope of declarations
        self.head = ""  # code since the last ; { or }
        self.parentheses = 0

    def declares(self):
        return all(self.stack)

    def feed(self, code):
        if code.lstrip().startswith("#"):
            return
        for c in code + "\n":
            if c == "(":
                self.parentheses += 1
            elif c == ")":
                self.parentheses = max(0, self.parentheses - 1)
            if c == "{":
                head = re.sub(r"template\s*<[^{}]*?>\s*(?=\b(class|struct|union)\b)", "", self.head)
                is_scope = self.parentheses == 0 and bool(SCOPE_WORDS.search(head)) and "=" not in head
                # `struct X f() {` is a function; `class alignas(64) X {` is not.
                if is_scope and re.search(r"\)\s*(const|noexcept|override|final|\s)*$", head):
                    is_scope = False
                self.stack.append(is_scope)
                self.head = ""
            elif c == "}":
                if self.stack:
                    self.stack.pop()
                self.head = ""
            elif c == ";" and self.parentheses == 0:
                self.head = ""
            elif c == ":" and re.search(r"\b(public|private|protected)\s*$", self.head):
                self.head = ""
            else:
                self.head += c


def is_declaration(code):
    """Whether the first code after a comment block can be documented by it."""
    stripped = code.strip()
    if not stripped or stripped.startswith(("#", "}", ")", "{")):
        return False
    return not re.match(r"(using namespace|namespace|public|private|protected|static_assert|friend|extern \"C\")\b",
                        stripped)


def convert(lines):
    state = {"block": False, "raw": None}
    scopes = Scopes()
    parsed = []  # code, column of the comment, declares before, the scope's head before
    for line in lines:
        inside = state["block"] or state["raw"] is not None
        code, column = split_line(line, state)
        parsed.append((code, None if inside and column is None else column, scopes.declares(),
                       scopes.head.strip(), scopes.parentheses))
        scopes.feed(code)

    out = list(lines)

    def text_of(n):
        return lines[n][parsed[n][1] + 2:]

    def is_plain(n):
        """Whether the line is nothing but a // comment that is not a Doxygen comment yet."""
        code, column = parsed[n][:2]
        return column is not None and not code.strip() and not text_of(n).startswith(("/", "!"))

    n = 0
    # The comment at the top of the file; lines before it may be empty.
    while n < len(lines) and not lines[n].strip():
        n += 1
    if n < len(lines) and is_plain(n) and parsed[n][1] == 0:
        first = n
        while n < len(lines) and is_plain(n):
            # docs/Doxyfile.in defines @filehead as @file and a line break: no line is added here.
            out[n] = ("/// @filehead" if n == first else "///") + escape(text_of(n))
            n += 1

    while n < len(lines):
        code, column, declares, head, parentheses = parsed[n]
        if is_plain(n):
            first = n
            while n < len(lines) and is_plain(n) and parsed[n][1] == column:
                n += 1
            follows = parsed[n][0] if n < len(lines) else ""
            # Between the parts of one declaration (head is not empty) a comment is no description, but between
            # enumerators it is.
            at_start = head == "" or head.endswith(",") or head.endswith(":")
            if declares and parentheses == 0 and at_start and is_declaration(follows):
                for k in range(first, n):
                    out[k] = lines[k][:column] + "///" + escape(text_of(k))
            continue
        if column is not None and code.strip() and declares and parentheses == 0 and not text_of(n).startswith(
                ("/", "!", "<")):
            stripped = code.strip()
            if not stripped.startswith(("#", "}")) and documents(parsed, n):
                out[n] = lines[n][:column] + "///<" + escape(text_of(n))
                k = n + 1
                while k < len(lines) and is_plain(k) and parsed[k][1] == column:
                    out[k] = lines[k][:column] + "///<" + escape(text_of(k))
                    k += 1
                n = k
                continue
        n += 1
    return out


def documents(parsed, n):
    """Whether a trailing comment stands after a complete member or enumerator, not amid a longer declaration."""
    stripped = parsed[n][0].strip()
    if stripped.endswith(";"):
        return True
    # A function whose body is on its own line.
    if stripped.endswith("}") and stripped.count("{") == stripped.count("}"):
        return True
    # Enumerators end with a comma or, the last one, with nothing before the closing brace.
    if stripped.endswith(","):
        return bool(re.fullmatch(r"\w+(\s*=\s*[^,;]+)?,", stripped))
    following = next((p[0].strip() for p in parsed[n + 1:] if p[0].strip()), "")
    return following.startswith("}") and bool(re.fullmatch(r"\w+(\s*=\s*[^,;]+)?", stripped))


def main():
    if len(sys.argv) != 2:
        sys.stderr.write(__doc__)
        return 2
    with open(sys.argv[1], encoding="utf-8") as file:
        lines = file.read().split("\n")
    out = convert(lines)
    sys.stdout.write("\n".join(out))
    return 0


if __name__ == "__main__":
    sys.exit(main())
