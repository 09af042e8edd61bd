"""Runs the examples, and compares what they print with docs/guide/python.md."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
EXAMPLES = os.path.join(ROOT, "examples", "python")


class Examples(unittest.TestCase):
    def test_every_example_prints_what_the_guide_says(self):
        with open(os.path.join(ROOT, "docs", "guide", "python.md"), encoding="utf-8") as file:
            guide = file.read()
        names = sorted(name for name in os.listdir(EXAMPLES) if name.endswith(".py"))
        self.assertGreaterEqual(len(names), 6)
        for name in names:
            # The first block of plain text after the example's name is its output.
            found = re.search(re.escape(f"examples/python/{name})") + r".*?```text\n(.*?)```", guide, re.DOTALL)
            self.assertTrue(found, f"docs/guide/python.md does not show {name}")
            with tempfile.TemporaryDirectory() as folder, self.subTest(name):
                result = subprocess.run([sys.executable, os.path.join(EXAMPLES, name)], cwd=folder,
                                        capture_output=True, text=True)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stdout, found.group(1))

    def test_the_code_of_the_guide_runs(self):
        with open(os.path.join(ROOT, "docs", "guide", "python.md"), encoding="utf-8") as file:
            code = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        self.assertGreater(len(code), 4)
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            try:
                names = {"__name__": "guide"}
                for block in code:
                    exec(compile(block, "python.md", "exec"), names)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
