"""Command line: ``python -m generator build | site | check | census | dcf | pin | explain``."""

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from urllib.parse import urlsplit

from generator import VERSION
from generator.write import digest, is_current, save, write

_STATE = ".state.json"
_ROOT = Path(__file__).resolve().parent.parent

_EPILOG = """\
The way of the data:  spec/*.yaml -> load -> elaborate -> check -> emit -> generated/

Examples:
  python -m generator build                     make what is missing or out of date
  python -m generator site                      build the reference as a folder to be published
  python -m generator check                     look for problems, write nothing
  python -m generator check --format json       the same for an editor or CI
  python -m generator census > facts.txt        all facts, one a line; compare two with diff
  python -m generator explain code-index        what a rule demands
  python -m generator dcf --device e94aycca --slot MXI1 --product 9400_StateLine --node 5 --baud 250
                                                the DCF and the EDS of one device on a bus

Exit status: 0 done, 1 problems in spec (nothing is written), 2 wrong usage.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command == "explain":
        return _explain(options.rule)
    if not options.spec.is_dir():
        parser.error(f"there is no folder {options.spec}")
    try:
        return _run(options)
    except OSError as error:
        place = error.filename or "the output"
        print(f"error: cannot write {place}: {error.strerror or error}; nothing was written", file=sys.stderr)
        return 1


def _run(options: argparse.Namespace) -> int:
    if options.command in ("build", "site"):
        url = options.url if options.command == "site" else None
        return _build(options.spec, options.out, options.format, url)
    if options.command == "dcf":
        return _dcf(options)
    if options.command == "pin":
        return _pin(options.spec, options.format)
    return _report(options.spec, options.format, census=options.command == "census")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m generator",
        description="Compile transcribed drive manuals to EDS, C, Python, Rust, JSON and HTML.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"drivespec {VERSION}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="command")
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--spec", type=Path, default=_ROOT / "spec", help="folder of the spec (default: spec)")
    common.add_argument("--format", choices=("text", "json"), default="text", help="form of the diagnostics")
    build = commands.add_parser("build", parents=[common], help="check the spec and write every artifact")
    build.add_argument(
        "--out", type=Path, default=_ROOT / "generated", help="folder of the artifacts (default: generated)"
    )
    site = commands.add_parser(
        "site", parents=[common], help="check the spec and build the reference: one folder, for any host or none"
    )
    site.add_argument(
        "--out", type=Path, default=_ROOT / "generated" / "html", help="folder of the site (default: generated/html)"
    )
    site.add_argument(
        "--url",
        type=_address,
        default="",
        help="address that the folder will have, https://host/path/; adds sitemap.xml, which must name addresses in "
        "full, and canonical links; without it there are none, and every link is relative in both cases",
    )
    commands.add_parser("check", parents=[common], help="check the spec and write nothing")
    commands.add_parser(
        "census", parents=[common], help="print every fact, one a line, and the coverage of each manual"
    )
    dcf = commands.add_parser(
        "dcf",
        parents=[common],
        help="write the DCF and the EDS of one device, with its node-ID and settings",
        epilog="VALUE is a number (in the unit of the code; 0x... as it travels), the label of a selection list, a "
        "text, or $NODEID + 0x...",
    )
    dcf.add_argument("--device", help="id of the device; may be left out where there is one CANopen device")
    dcf.add_argument("--slot", help="slot of the module; may be left out where there is one")
    dcf.add_argument(
        "--product", help="base drive as in the names of the EDS files; may be left out where there is one"
    )
    dcf.add_argument("--node", required=True, metavar="ID", help="node-ID")
    dcf.add_argument("--baud", required=True, metavar="RATE", help="bit rate in kbit/s")
    dcf.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        dest="settings",
        help="value of a code or object: C13351=2, C13320/1=0x185, I-1017=100; may be repeated",
    )
    dcf.add_argument("--out", type=Path, default=Path(), help="folder of the two files (default: the working folder)")
    commands.add_parser(
        "pin", parents=[common], help="write the public names to spec/names.yaml, for the next versions to keep"
    )
    explain = commands.add_parser("explain", help="say what a rule demands")
    explain.add_argument("rule", nargs="?", help="id of the rule, as in error[RULE]; without it all rules are listed")
    return parser


def _address(text: str) -> str:
    """Address of a folder on the web, with the slash at its end; "" for none."""
    if not text:
        return ""
    parts = urlsplit(text)
    if parts.scheme not in ("http", "https") or not parts.netloc or parts.query or parts.fragment:
        raise argparse.ArgumentTypeError(f"'{text}' is no address like https://host/path/")
    return text.rstrip("/") + "/"


def _label(spec: Path) -> str:
    """Name of the spec folder in messages: relative to the working folder where it lies below it."""
    try:
        return spec.resolve().relative_to(Path.cwd()).as_posix()
    except ValueError:
        return spec.as_posix()


def _build(spec: Path, out: Path, style: str, url: str | None) -> int:
    """Build the artifacts, or the site where there is a ``url``, which may be empty."""
    sources = _digests(spec)
    own = [_digests(_ROOT / "generator"), _digests(_ROOT / "templates"), digest((_ROOT / "LICENSE").read_bytes())]
    parts = [VERSION, *own, sources, url]
    state = digest(json.dumps(parts).encode())
    if _state(out) == state and is_current(out):
        print(f"{out.name}: up to date")
        return 0
    from generator.diagnostics import DiagnosticsError
    from generator.pipeline import compile_model, render, render_site

    try:
        model = compile_model(spec, _label(spec))
        files = render(model) if url is None else render_site(model, url)
    except DiagnosticsError as error:
        return _show(error, style)
    changed = write(out, files, sources)
    with suppress(OSError):  # without it the next build makes everything again
        (out / _STATE).write_text(json.dumps(state), encoding="ascii")
    print(f"{out.name}: {len(files)} files, {len(changed)} files changed")
    return 0


def _digests(folder: Path) -> dict[str, str]:
    """Digests of the files below a folder that go into a build, by path."""
    return {
        path.relative_to(folder).as_posix(): digest(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    }


def _state(out: Path) -> str | None:
    try:
        value = json.loads((out / _STATE).read_bytes())
    except (OSError, ValueError):
        return None
    return value if isinstance(value, str) else None


def _report(spec: Path, style: str, *, census: bool) -> int:
    from generator.diagnostics import DiagnosticsError
    from generator.pipeline import compile_model

    try:
        model = compile_model(spec, _label(spec))
    except DiagnosticsError as error:
        return _show(error, style)
    if census:
        from generator.census import lines

        sys.stdout.write("".join(f"{line}\n" for line in lines(model)))
    elif style == "json":
        print("[]")
    else:
        counts = ", ".join(f"{d.id}: {len(d.codes)} codes, {len(d.objects)} objects" for d in model.devices)
        print(f"no problems ({counts})")
    return 0


def _dcf(options: argparse.Namespace) -> int:
    from generator import mistakes
    from generator.dcf import Request, files
    from generator.diagnostics import DiagnosticsError
    from generator.pipeline import compile_model, reported

    request = Request(
        device=options.device,
        slot=options.slot,
        product=options.product,
        node=options.node,
        bit_rate=options.baud,
        settings=tuple(options.settings),
    )
    try:
        model = compile_model(options.spec, _label(options.spec))
        with reported():
            contents = {name: output.data() for name, output in files(model, request).items()}
    except DiagnosticsError as error:
        return _show(error, options.format)
    except mistakes.MistakesError as error:
        if options.format == "json":
            sys.stdout.write(mistakes.as_json(error.mistakes))
        else:
            sys.stderr.write(mistakes.as_text(error.mistakes) + "\nnothing was written\n")
        return 2
    save(options.out, contents)
    for name in contents:
        print(options.out / name)
    return 0


def _pin(spec: Path, style: str) -> int:
    from generator.diagnostics import DiagnosticsError
    from generator.emit.pins import text
    from generator.pipeline import compile_model

    try:
        content = text(compile_model(spec, _label(spec)))
    except DiagnosticsError as error:
        return _show(error, style)
    save(spec, {"names.yaml": content.encode("ascii")})
    print(spec / "names.yaml")
    return 0


def _show(error: Exception, style: str) -> int:
    from generator.diagnostics import DiagnosticsError, SourceText, as_json, as_text

    assert isinstance(error, DiagnosticsError)
    if style == "json":
        sys.stdout.write(as_json(error.diagnostics))
        return 1
    sys.stderr.write(as_text(error.diagnostics, SourceText(Path.cwd())))
    count = len(error.diagnostics)
    sys.stderr.write(f"\n{count} problem{'s' if count > 1 else ''}; nothing was written\n")
    return 1


def _explain(rule: str | None) -> int:
    from generator.rules import RULES

    if rule is None:
        width = max(len(name) for name in RULES)
        for name, text in RULES.items():
            print(f"{name:{width}}  {text}")
        return 0
    if rule not in RULES:
        from generator.diagnostics import suggestion

        print(f"there is no rule '{rule}'; {suggestion(rule, list(RULES), 'rules')}", file=sys.stderr)
        return 2
    print(f"{rule}: {RULES[rule]}")
    return 0
