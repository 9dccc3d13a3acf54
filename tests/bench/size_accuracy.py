#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Size against accuracy of compact .sep files, as a table and a plot (docs/separation.md).

    size_accuracy.py SPECTRACE FOLDER OUT [--qualities 1 2 ...] [-- OPTIONS OF reproduce]

Runs `SPECTRACE reproduce FOLDER` once a quality into OUT/q<N> (resumable, as reproduce is), takes the means over the
materials, prints them, and writes OUT/size_accuracy.svg.
"""
import argparse
import json
import pathlib
import subprocess

# What is drawn: a model, its reference, a name for the legend, a colour told apart by the colour-blind.
CURVES = [
    ("diffraction", "tabulated", "diffraction, against the table X", "#009e73"),
    ("residual", "raw", "residual, against the measurement", "#0072b2"),
]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 640, 400, 60, 40, 20, 50


def means(report: pathlib.Path, model: str, reference: str) -> tuple[float, float]:
    """Megabytes and PSNR [dB]."""
    for mean in json.loads((report / "results.json").read_text())["means"]:
        if mean["model"] == model and mean["reference"] == reference:
            return mean["megabytes"], mean["psnr"]
    raise SystemExit(f"{report}: no mean of {model} against {reference}")


def plot(points: dict[str, list[tuple[int, float, float]]]) -> str:
    sizes = [size for curve in points.values() for _, size, _ in curve]
    psnrs = [psnr for curve in points.values() for _, _, psnr in curve]
    x_top = max(sizes) * 1.08
    y_low, y_top = int(min(psnrs)) - 1, int(max(psnrs)) + 2

    def x(size: float) -> float:
        return LEFT + size / x_top * (WIDTH - LEFT - RIGHT)

    def y(psnr: float) -> float:
        return TOP + (y_top - psnr) / (y_top - y_low) * (HEIGHT - TOP - BOTTOM)

    svg = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="{LEFT}" y="{HEIGHT - 8}">size of a .sep file [MB], mean over the materials</text>',
        f'<text x="{LEFT}" y="16">PSNR [dB]; numbers: --quality</text>',
    ]
    step = max(1, (y_top - y_low) // 6)
    for psnr in range(y_low, y_top + 1, step):
        svg.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(psnr):.1f}" y2="{y(psnr):.1f}" stroke="#dddddd"/>'
                   f'<text x="{LEFT - 6}" y="{y(psnr) + 4:.1f}" text-anchor="end">{psnr}</text>')
    for i in range(int(x_top / 0.1) + 1):
        svg.append(f'<text x="{x(i * 0.1):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{i * 0.1:.1f}</text>')
    for row, (model, reference, name, colour) in enumerate(CURVES):
        curve = points[model]
        path = " ".join(f"{x(size):.1f},{y(psnr):.1f}" for _, size, psnr in curve)
        svg.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        svg.append(f'<text x="{WIDTH - RIGHT - 250}" y="{HEIGHT - BOTTOM - 30 + 16 * row}" fill="{colour}">{name}</text>')
        for quality, size, psnr in curve:
            svg.append(f'<circle cx="{x(size):.1f}" cy="{y(psnr):.1f}" r="3" fill="{colour}"/>'
                       f'<text x="{x(size):.1f}" y="{y(psnr) - 7:.1f}" text-anchor="middle">{quality}</text>')
    return "\n".join(svg + ["</svg>", ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spectrace")
    parser.add_argument("folder")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--qualities", type=int, nargs="+", default=[1, 2, 3, 4, 5, 7, 9, 11])
    arguments, options = parser.parse_known_args()
    points: dict[str, list[tuple[int, float, float]]] = {model: [] for model, *_ in CURVES}
    print("quality  " + "  ".join(f"{name:>42}" for _, _, name, _ in CURVES))
    for quality in arguments.qualities:
        report = arguments.out / f"q{quality}"
        report.parent.mkdir(parents=True, exist_ok=True)
        command = [arguments.spectrace, "reproduce", arguments.folder, "-o", str(report), "--quality", str(quality)]
        subprocess.run(command + [o for o in options if o != "--"], check=True, stdout=subprocess.DEVNULL)
        cells = []
        for model, reference, _, _ in CURVES:
            size, psnr = means(report, model, reference)
            points[model].append((quality, size, psnr))
            cells.append(f"{size:>20.3f} MB {psnr:>15.3f} dB")
        print(f"{quality:>7}  " + "  ".join(f"{cell:>42}" for cell in cells), flush=True)
    (arguments.out / "size_accuracy.svg").write_text(plot(points))


if __name__ == "__main__":
    main()
