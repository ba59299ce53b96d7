#!/usr/bin/env python3
"""Lists comments that begin without a noun or a verb ("Of the …", "Whether …", "By which …").

    scripts/check-words.py [FOLDER ...]     default: the whole tree

Reads the files under version control: comments of C++, and comments and docstrings of Python and shell. Only the first line
of a comment counts; lines below it continue it. Prints file:line: text of each. Exit code 1 if there is any.
"""

import ast
import io
import os
import re
import subprocess
import sys
import tokenize

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIRST_WORDS = (
    "Of|As|Its|It|What|Whether|By|That|Which|How|Where|When|Whose|In which|With which|From which|Those|So|Not|And|But"
)
# In small letters they continue the declaration before them, as in "double width; ///< of a line [px]".
WITHOUT_NOUN_OR_VERB = re.compile(rf"(?:{FIRST_WORDS})\b(?!-)")
# Strings come first, so that a "//" within one is not taken for a comment.
CPP = re.compile(
    r"""R"(?P<end>[^()\s]*)\(.*?\)(?P=end)" | "(?:\\.|[^"\\\n])*" | (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'"""
    r"""| (?P<comment>//[^\n]*|/\*.*?\*/)""",
    re.DOTALL | re.VERBOSE,
)
CPP_MARK = re.compile(r"/\*[*!]?|///?<?")


def comments_of_cpp(text):
    """Line, column and text of each comment, without its mark."""
    for match in CPP.finditer(text):
        if match["comment"]:
            line_start = text.rfind("\n", 0, match.start()) + 1
            line = text.count("\n", 0, match.start()) + 1
            yield line, match.start() - line_start, CPP_MARK.sub("", match["comment"], count=1)


def comments_of_python(text):
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield *token.start, token.string[1:]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            yield node.body[0].lineno, node.body[0].col_offset, ast.get_docstring(node)


def comments_of_shell(text):
    """Comments with a line of their own; what follows a command may be part of a string."""
    for line, words in enumerate(text.splitlines(), 1):
        match = re.match(r"\s*#(?!!)", words)
        if match:
            yield line, match.end() - 1, words[match.end():]


READERS = {".h": comments_of_cpp, ".cc": comments_of_cpp, ".py": comments_of_python, ".sh": comments_of_shell}


def beginnings(comments, lines):
    """Comments that do not continue one in the line above: behind code, or not below another that begins in the same column."""
    above = (-1, -1)
    for line, column, words in sorted(comments):
        is_behind_code = bool(lines[line - 1][:column].strip())
        if is_behind_code or (line - 1, column) != above:
            yield line, words.strip()
        above = (line, column)


def flagged(path):
    reader = READERS[os.path.splitext(path)[1]]
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = file.read()
    for line, words in beginnings(reader(text), text.split("\n")):
        if WITHOUT_NOUN_OR_VERB.match(words):
            yield line, words.splitlines()[0]


def files(folders):
    listed = subprocess.run(["git", "ls-files", "--", *folders], cwd=ROOT, check=True, capture_output=True, text=True)
    return [
        path
        for path in listed.stdout.splitlines()
        if os.path.splitext(path)[1] in READERS and not path.startswith("third_party/")
    ]


def main(folders):
    found = [(path, line, words) for path in files(folders) for line, words in flagged(path)]
    for path, line, words in found:
        print(f"{path}:{line}: {words}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
