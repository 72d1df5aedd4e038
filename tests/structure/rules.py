"""The rules that the tree keeps, one function each: rule(Tree) → list of violations in words.

A Tree is a folder of files; the rules look at nothing else, so that a test can hand them a small broken one.
"""
import json
import re
import subprocess
from pathlib import Path

SOURCES = (".h", ".cpp")
SKIPPED_FOLDERS = {".git", "build", "out", "node_modules", "__pycache__"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
HOUSE = "tests/structure/rooms.json"


class Tree:
    """Relative path → text of every text file; `house` is the content of rooms.json."""

    def __init__(self, root, house=None):
        self.root = Path(root)
        self.files = {}
        for path in self._paths():
            try:
                self.files[path] = (self.root / path).read_text(encoding="utf-8")
            except (UnicodeDecodeError, FileNotFoundError, IsADirectoryError):
                pass  # a picture, or a file deleted but not yet committed
        self.house = house or json.loads(self.files[HOUSE])

    def _paths(self):
        if (self.root / ".git").exists():
            listing = subprocess.run(
                ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                cwd=self.root, capture_output=True, text=True)
            if listing.returncode == 0:
                return sorted({path for path in listing.stdout.split("\0") if path})
        paths = (path.relative_to(self.root) for path in self.root.rglob("*") if path.is_file())
        return sorted(str(path) for path in paths if not SKIPPED_FOLDERS & set(path.parts))

    def under(self, *folders, suffixes=SOURCES):
        for path, text in self.files.items():
            if path.endswith(tuple(suffixes)) and path.startswith(tuple(folder + "/" for folder in folders)):
                yield path, text

    def sources(self):
        return self.under("configs", "renderer", "calibration", "server", "tests")

    def room_of(self, path):
        """The longest room that holds the path, or None."""
        rooms = [room for room in self.house["rooms"] if path.startswith(room + "/")]
        return max(rooms, key=len, default=None)

    def may_see(self, room, other):
        def matches(pattern):
            return other.startswith(pattern[:-1]) if pattern.endswith("*") else (other + "/").startswith(pattern + "/")
        if other == "tests" and room != "tests":
            return False
        return room == other or any(matches(pattern) for pattern in self.house["rooms"][room])


def includes(text):
    """(is_ours, name) of every include."""
    return [(kind == '"', name) for kind, name in INCLUDE.findall(text)]


def include_directions(tree):
    wrong = []
    for path, text in tree.sources():
        room = tree.room_of(path)
        if room is None:
            wrong.append(f"{path}: stands in no room of {HOUSE}")
            continue
        for ours, name in includes(text):
            other = tree.room_of(name)
            if other and not tree.may_see(room, other):
                wrong.append(f"{path}: {room} may not include {name}")
            elif ours and other is None:
                wrong.append(f'{path}: "{name}" is not named from the root of the repository')
            elif ours and name not in tree.files:
                wrong.append(f'{path}: "{name}" does not exist')
    return wrong


def link_directions(tree):
    """The same directions for the LINKS and PRIVATE_LINKS of cupola_room()."""
    wrong = []
    targets = {room.replace("/", "_"): room for room in tree.house["rooms"]}
    for path, text in tree.files.items():
        if not path.endswith("CMakeLists.txt"):
            continue
        for call in re.findall(r"cupola_room\(([^)]*)\)", re.sub(r"#.*", "", text)):
            name, *words = call.split()
            links = [word for word in words[words.index("LINKS"):] if word in targets] if "LINKS" in words else []
            if "PRIVATE_LINKS" in words:
                links += [word for word in words[words.index("PRIVATE_LINKS"):] if word in targets]
            if name not in targets:
                wrong.append(f"{path}: {name} is not a room of {HOUSE}")
                continue
            wrong += [f"{path}: {targets[name]} may not link {targets[link]}" for link in dict.fromkeys(links)
                      if not tree.may_see(targets[name], targets[link])]
    return wrong


def no_gl_in_maths(tree):
    gl = tuple(tree.house["gl_headers"])
    return [f"{path}: includes <{name}>, but this room knows no GL"
            for path, text in tree.under(*tree.house["no_gl"])
            for _, name in includes(text) if name.startswith(gl)]


def heavy_headers_in_sources_only(tree):
    heavy, allowed = tuple(tree.house["heavy_headers"]), tree.house["heavy_allowed_in"]
    return [f"{path}: <{name}> costs seconds in every file that includes this header; keep it in a .cpp"
            for path, text in tree.sources()
            if path.endswith(".h") and path not in allowed and not path.startswith("tests/")
            for _, name in includes(text) if name.startswith(heavy)]


def file_sizes(tree):
    limit, excepted = tree.house["line_limit"], tree.house["line_limit_exceptions"]
    kinds = SOURCES + (".glsl", ".py", ".js", ".mjs", ".cmake", ".inc", ".html", ".css")
    counted = [(path, text.count("\n")) for path, text in tree.files.items()
               if path.endswith(kinds) or path == "dev"]
    return [f"{path}: {lines} lines, the limit is {limit}" for path, lines in counted
            if lines > limit and path not in excepted]


def telling_names(tree):
    empty = re.compile(r"(^|[_\-.])(utils?|commons?|managers?|helpers?|misc)([_\-.]|$)", re.I)
    return [f"{path}: '{part}' does not say what it does" for path in tree.files
            for part in path.split("/") if empty.search(part)]


def nothing_left_undone(tree):
    mark = re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX|HA" r"CK)\b")
    return [f"{path}:{number}: {found.group(0)}" for path, text in tree.files.items()
            for number, line in enumerate(text.splitlines(), 1) if (found := mark.search(line))]


def globbed(call_file, text, word, files):
    """What `word` of a cupola_embed() list stands for: a file, or the files of a variable made by file(GLOB)."""
    here = call_file[:-len("CMakeLists.txt")]
    if not word.startswith("${"):
        return [path for path in (here + word, word) if path in files][:1]
    found = []
    for patterns in re.findall(rf"file\(GLOB {re.escape(word[2:-1])}\b([^)]*)\)", text):
        for pattern in patterns.split():
            pattern = pattern.replace("${CMAKE_CURRENT_SOURCE_DIR}/", here).replace("${PROJECT_SOURCE_DIR}/", "")
            shape = re.compile(re.escape(pattern).replace(r"\*", "[^/]*"))
            found += [path for path in files if shape.fullmatch(path)]
    return found


def shaders_are_embedded(tree):
    """Every .glsl stands in a cupola_embed() list, and nothing else does."""
    listed, wrong = set(), []
    for path, text in tree.files.items():
        if not path.endswith("CMakeLists.txt"):
            continue
        text = re.sub(r"#.*", "", text)
        for call in re.findall(r"cupola_embed\(([^)]*)\)", text):
            words = call.split()
            for word in words[words.index("FILES") + 1:] if "FILES" in words else []:
                found = globbed(path, text, word, tree.files)
                listed.update(found)
                if not found:
                    wrong.append(f"{path}: cupola_embed names {word}, which does not exist")
    shaders = {path for path in tree.files if path.endswith(".glsl")}
    return wrong + [f"{path}: in no cupola_embed() list" for path in sorted(shaders - listed)]


def dependencies_are_explained(tree):
    """docs/dependencies.md names every package that CMake looks for and every Debian package of packages.txt."""
    page = tree.files.get("docs/dependencies.md", "")
    asked = set()
    for path, text in tree.files.items():
        if path.endswith(("CMakeLists.txt", ".cmake")):
            text = re.sub(r"#.*", "", text)
            asked |= {(path, name) for name in re.findall(r"find_package\((\w[\w-]*)", text)}
            for words in re.findall(r"pkg_check_modules\(\w+([^)]*)\)", text):
                asked |= {(path, word) for word in words.split() if re.match(r"[a-z]", word)}
    for line in tree.files.get("packages.txt", "").splitlines():
        if line.strip() and not line.startswith("#"):
            asked.add(("packages.txt", line.split()[1]))
    return [f"{path}: docs/dependencies.md does not name {name}" for path, name in sorted(asked)
            if not re.search(rf"(?<![\w.+-]){re.escape(name)}(?![\w+-])", page)]


def code_ids_are_unique(tree):
    rows = re.findall(r'CUPOLA_CODE\((\w+), "([A-Z]+-\d+)"', tree.files.get("configs/model/codes.inc", ""))
    ids = [code for _, code in rows]
    return [f"configs/model/codes.inc: {code} stands twice" for code in sorted(set(ids)) if ids.count(code) > 1]


def lock_files_name_no_host(tree):
    return [f'{path}: a "resolved" line names a registry' for path, text in tree.files.items()
            if path.endswith("package-lock.json") and '"resolved"' in text]


def links_lead_somewhere(tree):
    """Relative links of Markdown pages lead to files; verbs of ./dev that they name exist."""
    wrong = []
    verbs = set(re.findall(r"\b(\w+)\b", " ".join(re.findall(r"^([\w | ]+)\) \"dev_", tree.files.get("dev", ""), re.M))))
    for path, text in tree.files.items():
        if not path.endswith(".md"):
            continue
        folder = Path(path).parent
        for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
            if not re.match(r"[a-z]+:", link) and not (tree.root / folder / link).exists():
                wrong.append(f"{path}: the link to {link} leads nowhere")
        wrong += [f"{path}: ./dev has no verb {verb}" for verb in re.findall(r"\./dev ([a-z]+)", text)
                  if verbs and verb not in verbs | {"help"}]
    return wrong


def table_of_directions(house):
    """The Markdown table of docs/ARCHITECTURE.md."""
    rows = ["| room | may include |", "|---|---|"]
    for room, others in house["rooms"].items():
        rows.append(f"| {room} | {', '.join(others).replace('*', 'everything' if others == ['*'] else '*') or 'nothing of ours'} |")
    return "\n".join(rows) + "\n"


def architecture_shows_the_table(tree):
    page = tree.files.get("docs/ARCHITECTURE.md", "")
    return [] if table_of_directions(tree.house) in page else [
        f"docs/ARCHITECTURE.md: its table is not that of {HOUSE}; python3 tests/structure/generated.py --table prints it"]


ALL = [include_directions, link_directions, no_gl_in_maths, heavy_headers_in_sources_only, file_sizes, telling_names,
       nothing_left_undone, shaders_are_embedded, dependencies_are_explained, code_ids_are_unique,
       lock_files_name_no_host, links_lead_somewhere, architecture_shows_the_table]
