# SPDX-License-Identifier: Apache-2.0
"""Tables that the commands of this folder keep in documents, each between two comments that name it."""
import pathlib
import sys


def replace_table(document: pathlib.Path, name: str, table: str) -> None:
    """Ends the program where the document has no place for it."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    text = document.read_text(encoding="utf-8")
    if text.count(begin) != 1 or text.count(end) != 1:
        sys.exit(f"{document}: no place for the table '{name}'")
    head, rest = text.split(begin)
    document.write_text(f"{head}{begin}\n{table}{end}{rest.split(end)[1]}", encoding="utf-8")
