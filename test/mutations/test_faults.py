#!/usr/bin/env python3
"""Whether the deliberate faults can be tried at all: their texts stand once, and their tests are programs."""

import re
import unittest

import run_mutations


class Faults(unittest.TestCase):
    def setUp(self):
        self.faults = run_mutations.read_faults()

    def test_texts_stand_once(self):
        for fault in self.faults:
            text = (run_mutations.SOURCES / fault.file).read_text()
            self.assertEqual(text.count(fault.before), 1, fault.name)
            self.assertNotEqual(fault.before, fault.after, fault.name)

    def test_tests_are_programs(self):
        listed = (run_mutations.SOURCES / "test/CMakeLists.txt").read_text()
        programs = set(re.findall(r"pcl_floam_add(?:_long)?_test(?:_program)?\(\s*(\w+)", listed))
        for fault in self.faults:
            self.assertTrue(fault.tests, fault.name)
            self.assertLessEqual({run_mutations.program(test) for test in fault.tests}, programs, fault.name)


if __name__ == "__main__":
    unittest.main()
