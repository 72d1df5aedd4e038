#!/usr/bin/env python3
"""Holds the tree to the rules of rules.py, and each rule to a small broken tree that it must refuse."""
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import rules

ROOT = Path(__file__).resolve().parents[2]

HOUSE = {
    "rooms": {"configs/model": [], "renderer/projection": ["configs/model"], "renderer/gl": [],
              "renderer/frame": ["configs/model", "renderer/*"], "tests": ["*"]},
    "no_gl": ["renderer/projection"], "gl_headers": ["epoxy/"], "heavy_headers": ["boost/"],
    "heavy_allowed_in": {}, "line_limit": 5, "line_limit_exceptions": {},
}

# A tree that keeps every rule.
GOOD = {
    "dev": 'build | test) "dev_$verb" "$@" ;;\n',
    "packages.txt": "# list\nbuild g++\n",
    "configs/model/show.h": "#pragma once\n",
    "configs/model/codes.inc": 'CUPOLA_CODE(a, "CFG-001", "", "")\nCUPOLA_CODE(b, "CFG-002", "", "")\n',
    "renderer/projection/map.h": '#include "configs/model/show.h"\n',
    "renderer/projection/map.glsl": "vec3 ray();\n",
    "renderer/frame/loop.cpp": '#include "renderer/projection/map.h"\n',
    "renderer/frame/CMakeLists.txt": "cupola_room(renderer_frame SOURCES loop.cpp LINKS renderer_projection)\n",
    "renderer/gl/CMakeLists.txt": "cupola_embed(renderer_gl FILES renderer/projection/map.glsl)\n",
    "tests/renderer/map_test.cpp": '#include "renderer/projection/map.h"\n',
    "CMakeLists.txt": "find_package(glm REQUIRED)\npkg_check_modules(x REQUIRED IMPORTED_TARGET epoxy)\n",
    "docs/dependencies.md": "glm, epoxy and g++\n",
    "docs/ARCHITECTURE.md": rules.table_of_directions(HOUSE),
    "README.md": "[plan](docs/ARCHITECTURE.md), run `./dev test`\n",
}

# rule → the files that break it, and only it.
BROKEN = {
    rules.include_directions: [
        {"configs/model/show.h": '#include "renderer/projection/map.h"\n'},
        {"renderer/projection/map.h": '#include "tests/renderer/map_test.cpp"\n'},
        {"renderer/gl/buffer.h": '#include "renderer/projection/map.h"\n'},
        {"renderer/frame/loop.cpp": '#include "map.h"\n'},
        {"renderer/frame/loop.cpp": '#include "renderer/projection/gone.h"\n'},
        {"renderer/attic/old.cpp": "int x;\n"},
    ],
    rules.link_directions: [
        {"renderer/gl/CMakeLists.txt": "cupola_room(renderer_gl SOURCES a.cpp PRIVATE_LINKS configs_model)\n"
                                       "cupola_embed(renderer_gl FILES renderer/projection/map.glsl)\n"},
        {"renderer/frame/CMakeLists.txt": "cupola_room(renderer_attic SOURCES a.cpp)\n"},
    ],
    rules.no_gl_in_maths: [{"renderer/projection/map.cpp": "#include <epoxy/gl.h>\n"}],
    rules.heavy_headers_in_sources_only: [{"renderer/gl/net.h": "#include <boost/asio.hpp>\n"}],
    rules.file_sizes: [{"renderer/frame/loop.cpp": "\n" * 6}],
    rules.telling_names: [{"renderer/gl/gl_utils.h": ""}, {"docs/helper.md": ""}],
    rules.nothing_left_undone: [{"configs/model/show.h": "// TO" + "DO: rest\n"}],
    rules.shaders_are_embedded: [
        {"renderer/projection/dome.glsl": ""},
        {"renderer/gl/CMakeLists.txt": "cupola_embed(renderer_gl FILES renderer/projection/map.glsl gone.glsl)\n"},
        {"renderer/gl/CMakeLists.txt": "file(GLOB s CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/renderer/*.glsl)\n"
                                       "cupola_embed(renderer_gl FILES ${s})\n"},
    ],
    rules.dependencies_are_explained: [
        {"CMakeLists.txt": "find_package(glm REQUIRED)\nfind_package(TBB)\n"},
        {"CMakeLists.txt": "pkg_check_modules(y REQUIRED IMPORTED_TARGET epoxy egl)\n"},
        {"packages.txt": "build g++\nbuild cmake\n"},
    ],
    rules.code_ids_are_unique: [
        {"configs/model/codes.inc": 'CUPOLA_CODE(a, "CFG-001", "", "")\nCUPOLA_CODE(b, "CFG-001", "", "")\n'}],
    rules.lock_files_name_no_host: [{"tests/panel/package-lock.json": '{"resolved": "x"}\n'}],
    rules.links_lead_somewhere: [{"README.md": "[plan](docs/PLAN.md)\n"}, {"README.md": "`./dev fly`\n"}],
    rules.architecture_shows_the_table: [{"docs/ARCHITECTURE.md": "| room |\n"}],
}


def broken_tree(changes):
    """Violations by rule of the good tree with some files replaced."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in {**GOOD, **changes}.items():
            target = Path(folder, path)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)
        tree = rules.Tree(folder, HOUSE)
        return {rule: rule(tree) for rule in rules.ALL}


class TheTree(unittest.TestCase):
    """One case per rule is added below."""


class TheRules(unittest.TestCase):
    """The good tree passes, and each rule sees what it is for; the added cases hold the latter."""

    def test_good_tree_passes(self):
        self.assertEqual({}, {rule.__name__: found for rule, found in broken_tree({}).items() if found})

    def test_shaders_may_be_globbed(self):
        found = broken_tree({"renderer/gl/CMakeLists.txt":
                             "file(GLOB s RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/renderer/*/*.glsl)\n"
                             "cupola_embed(renderer_gl FILES ${s})\n"})
        self.assertEqual([], found[rules.shaders_are_embedded])

    def test_every_rule_has_a_broken_tree(self):
        self.assertEqual(set(rules.ALL), set(BROKEN))


def add_cases():
    tree = rules.Tree(ROOT)
    for rule in rules.ALL:
        def holds(self, rule=rule):
            found = rule(tree)
            self.assertFalse(found, "\n" + "\n".join(found))
        setattr(TheTree, f"test_{rule.__name__}", holds)
        for number, changes in enumerate(BROKEN.get(rule, [])):
            def refused(self, rule=rule, changes=changes):
                by_rule = broken_tree(changes)
                self.assertTrue(by_rule[rule], f"not seen: {json.dumps(changes)}")
                others = {other.__name__: found for other, found in by_rule.items() if found and other is not rule}
                self.assertEqual({}, others, "the broken tree breaks other rules too")
            setattr(TheRules, f"test_{rule.__name__}_sees_{number}", refused)


add_cases()

if __name__ == "__main__":
    unittest.main()
