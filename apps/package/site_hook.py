"""Markdown as forges read it, for Python-Markdown: text below a list item is indented by four spaces, and a list may follow a
paragraph without a blank line. Outside fences only."""
import re

ITEM = re.compile(r"\s*([-*]|\d+\.) ")


def on_page_markdown(markdown, **_):
    lines, fenced, before = [], False, ""
    for line in markdown.split("\n"):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            line = re.sub(r"^ {2,3}(?=\S)", "    ", line)
            if re.match(r"([-*]|\d+\.) ", line) and before.strip() and not ITEM.match(before):
                lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines)
