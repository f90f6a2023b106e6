"""Tables and pictures of the experiments, as text, CSV and by gnuplot."""

import csv
import math
import subprocess
import sys


def log(text):
    print(text, file=sys.stderr, flush=True)


def number(value, digits, factor=1.0):
    if value is None or not math.isfinite(value):
        return "–"
    return f"{factor * value:.{digits}f}"


def markdown(header, rows):
    lines = ["| " + " | ".join(map(str, header)) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def publish(options, tables):
    """Writes and prints the tables: (name, title, header, rows). One CSV file each, one Markdown file for all."""
    texts = []
    for name, title, header, rows in tables:
        with open(options.output / f"{name}.csv", "w", newline="") as file:
            csv.writer(file).writerows([header] + rows)
        texts.append(f"**{title}**\n\n{markdown(header, rows)}\n")
    text = "\n".join(texts + [options.records.origin() + ".\n"])
    (options.output / f"{options.name}.md").write_text(text)
    print(text)
    log(f"written to {options.output}")


def bar_chart(options, name, title, unit, labels, series, logarithmic=False):
    """Groups of bars: `labels` below, `series` a list of (name, values); None leaves a bar out."""
    rows = [[label] + [values[i] for _, values in series] for i, label in enumerate(labels)]
    block = "\n".join('"{}" '.format(str(row[0]).replace('"', "'")) + " ".join(
        "NaN" if v is None or not math.isfinite(v) else f"{v:.6g}" for v in row[1:]) for row in rows)
    plots = ", ".join('$data using {}:xtic(1) title "{}"'.format(i + 2, s[0]) for i, s in enumerate(series))
    draw(f"""set terminal pngcairo noenhanced size 1000,520 font 'DejaVu Sans,10'
set output '{options.output / name}.png'
set title "{title}"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.85 noborder
set boxwidth 0.9
set border 3
set tics nomirror
set xtics rotate by -25
set grid ytics lc rgb '#e0e0e0'
set ylabel '{unit}'
set key outside right top
{'set logscale y' if logarithmic else 'set yrange [0:*]'}
$data << EOD
{block}
EOD
plot {plots}
""")


def draw(script):
    """Runs gnuplot; without it, or if it fails, the picture is missing and nothing else."""
    try:
        result = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True)
        if result.returncode != 0:
            log("gnuplot: " + result.stderr.strip())
    except FileNotFoundError:
        log("no picture: gnuplot is not installed")


def curves(options, name, title, axes, series, points=()):
    """Lines over two axes from 0 to 100 %: `axes` their names, `series` a list of (name, pairs); `points` alike, drawn as
    single marks."""
    blocks, plots = [], []
    for i, (label, pairs) in enumerate(list(series) + list(points)):
        style = "with steps lw 2" if i < len(series) else "with points pt 7 ps 1.6"
        blocks.append(f"$data{i} << EOD\n" + "\n".join(f"{x:.6g} {y:.6g}" for x, y in pairs) + "\nEOD\n")
        plots.append(f'$data{i} using 1:2 {style} title "{label}"')
    draw(f"""set terminal pngcairo noenhanced size 800,560 font 'DejaVu Sans,10'
set output '{options.output / name}.png'
set title "{title}"
set border 3
set tics nomirror
set grid xtics ytics lc rgb '#e0e0e0'
set xlabel '{axes[0]}'
set ylabel '{axes[1]}'
set xrange [-1:101]
set yrange [-1:101]
set key right bottom
{"".join(blocks)}plot {", ".join(plots)}
""")
