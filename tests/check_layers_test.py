#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants each fault check_layers.py is for, and expects it to bite."""
import tempfile
import unittest
from pathlib import Path

from check_layers import check


class CheckLayers(unittest.TestCase):
    def faults(self, file, line):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / file
            path.parent.mkdir(parents=True)
            path.write_text(f"// a comment\n{line}\n", encoding="utf-8")
            return check(Path(folder).resolve())[0]

    def assert_bites(self, file, line):
        faults = self.faults(file, line)
        self.assertEqual(len(faults), 1, f"{file}: {line}")
        self.assertTrue(faults[0].startswith(f"{file}:2: "), faults[0])

    def test_includes_that_point_right_or_across_are_faults(self):
        self.assert_bites("core/math/a.h", '#include "materials/bsdf.h"')
        self.assert_bites("materials/a.cpp", '#include "renderer/scene.h"')
        self.assert_bites("separation/a.cpp", '#include "renderer/scene.h"')
        self.assert_bites("renderer/a.cpp", '#  include "separation/separate.h"')
        self.assert_bites("renderer/a.cpp", '#include "cli/command.h"')
        self.assert_bites("core/a.cpp", '#include "tests/support/a.h"')
        self.assert_bites("core/a.cpp", '#include "../materials/bsdf.h"')

    def test_includes_that_point_left_are_none(self):
        self.assertEqual(self.faults("cli/a.cpp", '#include "separation/separate.h"'), [])
        self.assertEqual(self.faults("renderer/a.cpp", '#include "core/base/error.h"'), [])
        self.assertEqual(self.faults("core/base/a.cpp", '#include "spectrace_commit.h"'), [])
        self.assertEqual(self.faults("core/base/a.h", "#include <vector>"), [])

    def test_third_parties_away_from_their_door_are_faults(self):
        for file, include in [
            ("materials/a.cpp", "<nlohmann/json.hpp>"),
            ("core/base/a.h", "<nlohmann/json.hpp>"),
            ("core/image/a.h", "<OpenEXR/ImfRgba.h>"),
            ("cli/a.cpp", "<OpenImageIO/imageio.h>"),
            ("renderer/mesh.cpp", "<embree3/rtcore.h>"),
            ("materials/a.cpp", "<ceres/ceres.h>"),
            ("separation/a.h", "<ceres/ceres.h>"),
            ("renderer/a.cpp", "<Eigen/Core>"),
            ("renderer/scene.cpp", "<tiny_obj_loader.h>"),
            ("core/a.cpp", "<tbb/parallel_for.h>"),
            ("renderer/a.h", "<tbb/parallel_for.h>"),
            ("renderer/a.cpp", '"CLI/CLI.hpp"'),
            ("core/a.h", "<fmt/core.h>"),
            ("core/a.cpp", "<boost/optional.hpp>"),
        ]:
            self.assert_bites(file, f"#include {include}")

    def test_third_parties_at_their_door_are_none(self):
        for file, include in [
            ("core/base/json.cpp", "<nlohmann/json.hpp>"),
            ("core/image/exr.cpp", "<OpenEXR/ImfOutputFile.h>"),
            ("renderer/accel_embree.cpp", "<embree4/rtcore.h>"),
            ("separation/a.h", "<Eigen/Core>"),
            ("renderer/a.cpp", "<tbb/parallel_for.h>"),
            ("cli/command.h", "<CLI/CLI.hpp>"),
            ("core/a.cpp", "<fmt/format.h>"),
        ]:
            self.assertEqual(self.faults(file, f"#include {include}"), [])


if __name__ == "__main__":
    unittest.main()
