"""Writes blocks.pyi, the types of the functions that alhazen/blocks.py makes from the reader's tables.

Usage: PYTHONPATH=build/release/python python3 bindings/python/tools/make_stubs.py FILE
"""
import sys
import textwrap

from alhazen._blocks import VOCABULARY
from alhazen.blocks import _describe

HEAD = '''"""All blocks of the native scene format; made by bindings/python/tools/make_stubs.py."""
from typing import Any, List, Sequence, Union

from ._blocks import Block as Block, Call as Call, Word as Word

__all__: List[str]

def translate(x: float, y: float, z: float) -> Call: ...
def rotate(axis: Sequence[float], degrees: float) -> Call: ...
def scale(*factors: float) -> Call: ...
def matrix(rows: Any) -> Call: ...
def texture_input(name: str, factor: Any = ..., channel: str = ...) -> Call: ...
'''


def stubs() -> str:
    parts = [HEAD]
    for name, is_shape, keys in VOCABULARY:
        arguments = ["label: Union[str, Block] = ...", "*items: Block"] + [f"{key}: Any = ..." for key, *_ in keys]
        # No line ends within an argument.
        joined = ", ".join(a.replace(" ", "~") for a in arguments)
        head = textwrap.fill(f"def {name}({joined})~->~Block:", 118, break_long_words=False,
                             subsequent_indent=" " * len(f"def {name}(")).replace("~", " ")
        text = textwrap.indent(_describe(name, is_shape, keys), "    ").strip()
        parts.append(f'\n{head}\n    """{text}"""\n')
    return "".join(parts)


with open(sys.argv[1], "w", encoding="utf-8") as file:
    file.write(stubs())
