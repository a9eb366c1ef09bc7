"""Changes of one operator or constant in C++ sources: where they are, in which order they are drawn."""

import collections
import hashlib
import re

import yaml

# clang-format puts spaces around binary operators, and around nothing else that looks like one.
SWAPS = {"+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", ">": ">=", ">=": ">",
         "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=",
         "/=": "*=", "&": "|", "|": "&", "<<": ">>", ">>": "<<", "true": "false", "false": "true",
         "++": "--", "--": "++"}
TOKEN = re.compile(
    r"(?<= )(?P<operator>[+\-*/&|]|<=?|>=?|[=!]=|&&|\|\||[+\-*/]=|<<|>>)(?= |$)"
    r"|\b(?P<word>true|false)\b"
    r"|(?<![\w.'])(?P<number>\d[\d']*(?:\.\d*)?(?:e[+-]?\d+)?)(?P<suffix>[uUlLfF]*)(?![\w.'])"
    r"|(?P<step>\+\+|--)", re.M)
# What is no code, and code that only says what things are.
BLANKS = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
                    r"|^[ \t]*#[^\n]*|^(?:using|template|static_assert)\b[^\n]*", re.S | re.M)


class Change:
    """One token of one file, and what stands there instead.

    `path` is relative to the package's root. `shown` is the line with the change marked in brackets;
    where a file has several such lines, all but the first end in their number, as ` (2)`.
    """

    def __init__(self, path, text, match, replacement):
        self.path = str(path)
        self.start, self.end = match.span()
        self.line = text.count("\n", 0, self.start) + 1
        self.new = replacement
        begin = text.rfind("\n", 0, self.start) + 1
        end = text.find("\n", self.end)
        old = match.group(0)
        self.shown = f"{text[begin:self.start]}[{old} -> {replacement}]{text[self.end:end]}".strip()

    @property
    def place(self):
        return f"{self.path}:{self.line}"

    def applied(self, text):
        return text[:self.start] + self.new + text[self.end:]


def changed_number(digits):
    """The next integer; of others, a tenth more."""
    digits = digits.replace("'", "")
    if digits.isdigit():
        return str(int(digits) + 1)
    return repr(float(digits) * 1.1 or 0.1)


def changes_of(path, text):
    """All changes of the text of a file, from top to bottom."""
    code = BLANKS.sub(lambda found: re.sub(r"[^\n]", "~", found.group(0)), text)
    times = collections.Counter()
    for match in TOKEN.finditer(code):
        if match.group("number"):
            replacement = changed_number(match.group("number")) + match.group("suffix")
        else:
            replacement = SWAPS[match.group(0)]
        change = Change(path, text, match, replacement)
        times[change.shown] += 1
        if times[change.shown] > 1:
            change.shown += f" ({times[change.shown]})"
        yield change


def drawn(changes, seed):
    """Each once, in an order that looks random. What else changes in the sources does not alter
    the order of those that stay."""
    return sorted(changes, key=lambda change: hashlib.sha256(
        f"{seed} {change.path} {change.shown}".encode()).digest())


class Unobservable:
    """The list of changes that nothing can observe: for each file, `change` as it is shown, and `why`."""

    def __init__(self, text):
        self.reasons = {}
        for path, entries in (yaml.safe_load(text) or {}).items():
            for entry in entries:
                self.reasons[(path, entry["change"])] = entry["why"]

    def reason(self, change):
        """Empty if the change is not listed."""
        return self.reasons.get((change.path, change.shown), "")

    def unknown(self, changes):
        """Those of the list that are no changes of the sources."""
        present = {(change.path, change.shown) for change in changes}
        return [f"{path}: {shown}" for path, shown in self.reasons if (path, shown) not in present]
