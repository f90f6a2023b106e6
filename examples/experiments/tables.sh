#!/usr/bin/env bash
# All tables of all experiments, from the records that are there; nothing is run.
#
#   bash examples/experiments/tables.sh [--output DIR DIR...] [--commit COMMIT]
#
# DIR is what an experiment was given as --output; without it, all of the usual folders that have records. Below each
# table stands of which commits its runs are; --commit takes those alone whose commit begins so.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *
from records import FILE, read

parser = argparse.ArgumentParser(prog="tables.sh", description="all tables of all experiments from their records")
parser.add_argument("--output", type=pathlib.Path, nargs="+", metavar="DIR", help="folders of records")
parser.add_argument("--commit", help="only records whose commit begins so")
arguments = parser.parse_args()
folders = arguments.output or sorted(file.parent for file in USUAL_FOLDER.glob("*/" + FILE))
for folder in folders:
    experiments = sorted({record["experiment"] for record in read(folder, commit=arguments.commit)})
    if not experiments:
        log(f"{folder}: no records")
    for name in experiments:
        command = ["bash", HERE / "examples/experiments" / f"{name}.sh", "--tables", "--output", folder]
        print(f"## {name}\n", flush=True)
        subprocess.run(command + (["--commit", arguments.commit] if arguments.commit else []), check=True)
if not folders:
    sys.exit(f"no records in {USUAL_FOLDER}; --output DIR names another folder")
PYTHON
