#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_names.py finds two types with the same name anywhere below src, and reports nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOOL = ROOT / "tools" / "check_names.py"


def check(files: dict[str, str]) -> subprocess.CompletedProcess:
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            file = pathlib.Path(folder, "src", name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return subprocess.run([sys.executable, TOOL, folder], capture_output=True, text=True, check=False)


def inside(text: str, name: str = "embody::scene") -> str:
    return f"namespace {name} {{\n{text}\n}}\n"


class CheckNames(unittest.TestCase):
    def expect_twice(self, first: str, second: str, name: str = "embody::scene::Draft") -> None:
        for files in ({"scene/a.cpp": first, "cli/b.cpp": second}, {"a.h": second, "deep/er/still/b.cpp": first}):
            result = check(files)
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn(f"{name} is defined in", result.stdout)

    def expect_right(self, first: str, second: str) -> None:
        result = check({"a.cpp": first, "b.cpp": second})
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_an_empty_tree_is_no_success(self) -> None:
        self.assertEqual(check({"a.txt": "struct Draft {};"}).returncode, 1)

    def test_every_way_to_define_a_type(self) -> None:
        plain = inside("struct Draft { int a; };")
        for other in ("class Draft { };", "struct Draft final { };", "union Draft { int a; };", "enum class Draft : char { a };",
                      "struct alignas(64) Draft { };", "struct alignas(sizeof(int)) Draft final { };",
                      "template <class T = int> struct Draft { T a; };", "class [[nodiscard]] Draft { };",
                      "struct Draft : Other<int>, More { };", "int f() { return 1; }\nstruct Draft { };",
                      "namespace { struct Hidden { }; }\nstruct Draft { };"):
            with self.subTest(other):
                self.expect_twice(plain, inside(other))
        self.expect_twice(plain, "namespace embody { namespace scene { struct Draft { }; } }")

    def test_members_by_their_class(self) -> None:
        self.expect_twice(inside("struct Session::Draft { };"), inside("struct Session::Draft { };"),
                          "embody::scene::Session::Draft")
        self.expect_right(inside("struct Session::Draft { };"), inside("struct Other::Draft { };"))

    def test_what_are_two_types(self) -> None:
        plain = inside("struct Draft { };")
        for other in (inside("struct Draft { };", "embody::cli"), inside("namespace { struct Draft { }; }"),
                      inside("struct Draft;"), inside("void f() { struct Draft { }; }"), inside("struct Outer { struct Draft { }; };"),
                      inside("// struct Draft { };\nconst char* text = \"struct Draft { };\";"),
                      inside("template <> struct Draft<int> { };"), inside("Draft make() { return {}; }")):
            with self.subTest(other):
                self.expect_right(plain, other)

    def test_each_type_of_a_file_of_ours(self) -> None:
        """A copy of a class of the real sources in another file."""
        source = (ROOT / "src/physics/linear/block6.h").read_text()
        result = check({"a.h": source, "b.h": source})
        for name in ("Vec6", "Block6"):
            self.assertIn(f"embody::physics::linear::{name} is defined in src/a.h", result.stdout)


if __name__ == "__main__":
    unittest.main()
