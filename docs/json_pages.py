"""The page of what commands print with `--json`: made from the schemas, so that no field is forgotten."""

from pathlib import Path

from clamber.cli.printed.library import PRINTED, schema_of
from clamber.cli.printed.tables import tables_of, top_of


def write_json_page(docs: Path) -> None:
    """Write `api/json-fields.md`; untouched where it is as it should be."""
    parts = [
        "# Fields of the output",
        "What each command prints with `--json`; [the rules](../json.md). A field with a `?` may be missing. "
        "`clamber schema COMMAND` prints the same.",
    ]
    for command in PRINTED:
        schema = schema_of(command)
        parts.append(f"## {command}")
        if "properties" not in schema:
            parts.append(f"{top_of(schema)}.".capitalize() if top_of(schema)[0].islower() else f"{top_of(schema)}.")
        for table in tables_of(schema):
            if table.name != schema["title"]:
                parts.append(f"### {table.name} of {command}")
            if table.meaning:
                parts.append(table.meaning)
            rows = ["| field | holds | meaning |", "|---|---|---|"]
            rows += [f"| `{field}` | {_cell(holds)} | {_cell(meaning)} |" for field, holds, meaning in table.rows]
            parts.append("\n".join(rows))
    page, text = docs / "api" / "json-fields.md", "\n\n".join(parts) + "\n"
    page.parent.mkdir(exist_ok=True)
    if not page.is_file() or page.read_text() != text:
        page.write_text(text)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
