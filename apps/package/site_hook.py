"""What the site does to the pages. The experiment file's page becomes one page for each of its parts. Markdown as forges read
it is made Markdown as Python-Markdown does: text below a list item is indented by four spaces, and a list may follow a
paragraph without a blank line. Outside fences only."""
import re
from pathlib import Path

ITEM = re.compile(r"\s*([-*]|\d+\.) ")
PARTED = "configuration.md"
GROUPS = {  # of the section "Keys": title of a page, first names of its tables
    "Keys of beams": ("beam",),
    "Keys of chains and matrices": ("chain", "system"),
    "Keys of plane frames": ("frame",),
    "Keys of space frames": ("space_frame",),
    "Keys of loads, sensors and simulation": ("damping", "excitation", "excitations", "sensors", "acquisition", "simulation",
                                              "frequency_response"),
    "Keys of records": ("record",),
    "Keys of models, filters and studies": (),  # all others
}
anchors = {}  # of every heading behind the first part, its page


def slug(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def sections(text, mark):
    """What precedes the first heading of this mark, then (heading, text below it) of each; fences are no headings."""
    parts, fenced = [["", []]], False
    for line in text.split("\n"):
        fenced ^= line.lstrip().startswith("```")
        if line.startswith(mark + " ") and not fenced:
            parts.append([line[len(mark) + 1:], []])
        else:
            parts[-1][1].append(line)
    return [(heading, "\n".join(lines).strip() + "\n") for heading, lines in parts]


def group_of(heading):
    name = re.match(r"`\[+(\w+)", heading)
    if not name:
        return None
    return next((title for title, names in GROUPS.items() if name[1] in names), list(GROUPS)[-1])


def parts_of(text):
    """The page's own part, and {title: text} of the others."""
    (_, first), *others = sections(text, "##")
    parts = {}
    for heading, below in others:
        if heading == "Units and signs":
            first += f"\n## {heading}\n\n{below}"
        elif heading == "Keys":
            (_, general), *tables = sections(below, "###")
            first += f"\n## {heading}\n\n{general}"
            for name, table in tables:
                section = f"## {name}\n\n{table}\n"
                if group := group_of(name):
                    parts[group] = parts.get(group, "") + section
                else:
                    first += f"\n#{section}"
        else:
            parts[heading] = below
    return first, parts


def on_config(config):
    folder = Path(config["docs_dir"])
    first, parts = parts_of((folder / PARTED).read_text(encoding="utf-8"))
    pages = {}
    for title, text in parts.items():
        page = f"configuration/{slug(title)}.md"
        pages[title] = page
        anchors[slug(title)] = page
        anchors.update((slug(heading), page) for heading, _ in sections(text, "##")[1:])
    for title, text in parts.items():
        (folder / pages[title]).parent.mkdir(exist_ok=True)
        text = re.sub(r"\]\((?!#|https?:)", "](../", text)
        (folder / pages[title]).write_text(f"# {title}\n\n{text}", encoding="utf-8")
    listed = "".join(f"- [{title}]({page})\n" for title, page in pages.items())
    (folder / PARTED).write_text(f"{first}\n## Pages\n\n{listed}", encoding="utf-8")
    for part in config["nav"]:
        for entries in part.values():
            if PARTED in entries:
                entries[entries.index(PARTED)] = {"The experiment file": [PARTED, *pages.values()]}
    return config


def follow_parts(markdown, page):
    """Links to a heading of the parted page lead to the page that has it."""
    def moved(link):
        name, anchor = link[1], link[2]
        inside = page.file.src_path.startswith("configuration") and not name
        if anchor not in anchors or not (inside or name.endswith(PARTED)):
            return link[0]
        up = "../" * page.file.src_path.count("/")
        return f"]({up}{anchors[anchor]}#{anchor})"
    return re.sub(r"\]\(([^)#\s]*)#([\w-]+)\)", moved, markdown)


def on_page_markdown(markdown, page, **_):
    lines, fenced, before = [], False, ""
    for line in follow_parts(markdown, page).split("\n"):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            line = re.sub(r"^ {2,3}(?=\S)", "    ", line)
            if re.match(r"([-*]|\d+\.) ", line) and before.strip() and not ITEM.match(before):
                lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines)
