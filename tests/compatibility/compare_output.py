#!/usr/bin/env python3
"""Compares one output of two versions of vpe.

    compare_output.py OLD NEW

OLD and NEW are files or folders. Equal bytes count as "same". Otherwise the file is compared by content:
all but the places where it names the program's version (README.md lists them) and measured times. A word
that the newer version calls by another name (the tables below) counts as "renamed".

Prints "same", "renamed" or "DIFFERS", a tab, and the details. Exits with 1 on a difference. Needs nothing but
Python's standard library.
"""

import csv
import hashlib
import json
import re
import sqlite3
import struct
import sys
import zlib
from pathlib import Path

# Maps old words to new words. Extend these tables when an output's word changes on purpose.
KEYS = {
    "lod.rule": "lod.metric",
}
VALUES = {
    "voxel": "ray",
    "plain": "reference",
    "hitchner": "distance",
    "fit": "plane",
    "bend": "edges",
}
# Lists keys that hold a level of detail. Old versions count levels from 1 in front of people, new ones from 0.
LEVELS = {"level", "lod", "wanted_lod"}
# Lists keys that hold a sentence. Its words are free.
PROSE = {"what_this_means", "meaning", "reason", "treatment"}
# Lists keys that name the program's version or the command line, or that hash something which does.
VERSIONS = {"program", "version", "command", "fingerprint", "checksum"}
# Matches keys that hold measured times and the state of caches.
MEASURED = re.compile(r".*_ms$|bytes_resident$|pages_.*|processor_s$|seconds$")

VERSION_TEXT = re.compile(rb"\bvpe [0-9]+(\.[0-9]+)*")


class Difference(Exception):
    """Says where two outputs differ."""


class Notes:
    """Collects what was not compared, which words were renamed, and how far levels were shifted."""

    def __init__(self):
        self.ignored = set()
        self.renamed = set()
        self.level_shifts = set()

    def ignore(self, what):
        self.ignored.add(what)

    def rename(self, old, new):
        self.renamed.add(f"{old} -> {new}")

    def shift_level(self, shift, where):
        """Records a level's shift. Throws unless all levels of an output are shifted alike."""
        self.level_shifts.add(shift)
        if len(self.level_shifts) > 1:
            raise Difference(f"{where}: some levels differ by 1 and some are equal")

    def text(self):
        parts = []
        if self.ignored:
            parts.append("not compared: " + ", ".join(sorted(self.ignored)))
        if self.is_renamed():
            shifted = {"levels from 0"} if -1 in self.level_shifts else set()
            parts.append("renamed: " + ", ".join(sorted(self.renamed | shifted)))
        return "; ".join(parts)

    def is_renamed(self):
        return bool(self.renamed) or -1 in self.level_shifts


def short(value):
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


# Structured values


def compare_values(old, new, key, where, notes):
    """Compares two values of JSON, or two fields of a table."""
    if key in PROSE and isinstance(old, str) and isinstance(new, str):
        if old != new:
            notes.ignore(key)
        return
    if isinstance(old, dict) and isinstance(new, dict):
        compare_objects(old, new, where, notes)
        return
    if isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            raise Difference(f"{where}: {len(old)} and {len(new)} items")
        for i, (a, b) in enumerate(zip(old, new)):
            compare_values(a, b, key, f"{where}[{i}]", notes)
        return
    is_number = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (old, new))
    if key in LEVELS and is_number and new - old in (0, -1):
        notes.shift_level(int(new - old), where)
        return
    if type(old) is type(new) or is_number:
        if old == new:
            return
        if isinstance(old, str) and VALUES.get(old) == new:
            notes.rename(old, new)
            return
        if isinstance(old, str) and VALUES.get(old.split("=")[-1]) == new.split("=")[-1]:
            notes.rename(old, new)
            return
    raise Difference(f"{where}: {short(old)} and {short(new)}")


def compare_objects(old, new, where, notes):
    """Compares two objects of JSON, key by key. Their order does not count."""
    left = dict(new)
    for key, value in old.items():
        now = key if key in left else KEYS.get(key)
        if now not in left:
            raise Difference(f"{where}.{key}: missing from the new one")
        if now != key:
            notes.rename(key, now)
        other = left.pop(now)
        if key in VERSIONS or MEASURED.match(key):
            if value != other:
                notes.ignore(key)
            continue
        compare_values(value, other, key, f"{where}.{key}", notes)
    if left:
        raise Difference(f"{where}.{sorted(left)[0]}: only in the new one")


def compare_json(old, new, notes):
    """Compares JSON, or JSON lines."""
    try:
        a, b = json.loads(old), json.loads(new)
    except json.JSONDecodeError:
        a = [json.loads(line) for line in old.splitlines()]
        b = [json.loads(line) for line in new.splitlines()]
    compare_values(a, b, "", "", notes)
    return old


def compare_csv(old, new, notes):
    """Compares tables, field by field as text."""
    a = list(csv.reader(old.decode().splitlines()))
    b = list(csv.reader(new.decode().splitlines()))
    if not a or not b or len(a) != len(b):
        raise Difference(f"{len(a)} and {len(b)} lines")
    if len(a[0]) != len(b[0]):
        raise Difference(f"{len(a[0])} and {len(b[0])} columns")
    for was, now in zip(a[0], b[0]):
        if was == now:
            continue
        if KEYS.get(was) != now:
            raise Difference(f"column {was} is {now}")
        notes.rename(was, now)
    for number, (row, other) in enumerate(zip(a[1:], b[1:]), 2):
        if len(row) != len(other):
            raise Difference(f"line {number}: {len(row)} and {len(other)} fields")
        for name, x, y in zip(a[0], row, other):
            where = f"line {number}, {name}"
            if MEASURED.match(name) or name in VERSIONS:
                if x != y:
                    notes.ignore(name)
            elif name in LEVELS and x.isdigit() and y.isdigit():
                compare_values(int(x), int(y), name, where, notes)
            else:
                compare_values(x, y, name, where, notes)
    return old


def compare_text(old, new, notes):
    """Compares text word by word within lines, as flights and logs have them."""
    a, b = old.decode().splitlines(), new.decode().splitlines()
    if len(a) != len(b):
        raise Difference(f"{len(a)} and {len(b)} lines")
    for number, (line, other) in enumerate(zip(a, b), 1):
        if line == other:
            continue
        words, others = line.split(), other.split()
        if len(words) != len(others):
            raise Difference(f"line {number}: {short(line)} and {short(other)}")
        for x, y in zip(words, others):
            if x == y:
                continue
            key, _, value = x.partition("=")
            if VALUES.get(x) != y and f"{KEYS.get(key, key)}={VALUES.get(value, value)}" != y:
                raise Difference(f"line {number}: {short(x)} and {short(y)}")
            notes.rename(x, y)
    return old


def compare_toml(old, new, notes):
    """Compares settings without their comments."""

    def strip(data):
        return "\n".join(line.split("#")[0].rstrip() for line in data.decode().splitlines())

    if strip(old) != strip(new):
        compare_text(strip(old).encode(), strip(new).encode(), notes)
    notes.ignore("comments")
    return strip(old).encode()


# Images


def png_chunks(data):
    """Returns the chunks of a PNG as pairs of type and content."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Difference("not a PNG")
    chunks, at = [], 8
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    return chunks


def png_text(chunks):
    """Returns the text chunks of a PNG by keyword."""
    texts = {}
    for kind, content in chunks:
        if kind not in (b"tEXt", b"iTXt", b"zTXt"):
            continue
        keyword, _, rest = content.partition(b"\0")
        if kind == b"iTXt":
            packed = rest[0] == 1
            rest = rest[2:].split(b"\0", 2)[2]
            rest = zlib.decompress(rest) if packed else rest
        elif kind == b"zTXt":
            rest = zlib.decompress(rest[1:])
        texts[keyword.decode("latin-1")] = rest
    return texts


def png_rows(chunks):
    """Returns width, bytes of a pixel, and the unfiltered rows of a PNG that is not interlaced."""
    header = next(content for kind, content in chunks if kind == b"IHDR")
    width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", header)
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    if interlaced or depth < 8:
        raise Difference("pixels differ (a PNG that is interlaced or has less than 8 bits)")
    step = channels * depth // 8
    data = zlib.decompress(b"".join(content for kind, content in chunks if kind == b"IDAT"))
    stride = width * step
    above = bytearray(stride)
    rows = []
    for y in range(height):
        start = y * (stride + 1)
        rule = data[start]
        row = bytearray(data[start + 1 : start + 1 + stride])
        if rule == 1:
            for i in range(step, stride):
                row[i] = (row[i] + row[i - step]) & 255
        elif rule == 2:
            for i in range(stride):
                row[i] = (row[i] + above[i]) & 255
        elif rule == 3:
            for i in range(stride):
                west = row[i - step] if i >= step else 0
                row[i] = (row[i] + (west + above[i]) // 2) & 255
        elif rule == 4:
            for i in range(stride):
                west = row[i - step] if i >= step else 0
                corner = above[i - step] if i >= step else 0
                guess = west + above[i] - corner
                best = min((abs(guess - v), n, v) for n, v in enumerate((west, above[i], corner)))
                row[i] = (row[i] + best[2]) & 255
        rows.append(bytes(row))
        above = row
    return width, step, rows


def describe_pixels(old, new):
    """Says how the pixels of two PNGs differ."""
    width, step, a = png_rows(old)
    other_width, other_step, b = png_rows(new)
    if (width, step, len(a)) != (other_width, other_step, len(b)):
        return f"{width}x{len(a)} and {other_width}x{len(b)} pixels of {step} and {other_step} bytes"
    count, largest, first = 0, 0, None
    for y, (row, other) in enumerate(zip(a, b)):
        if row == other:
            continue
        for x in range(width):
            p, q = row[x * step : (x + 1) * step], other[x * step : (x + 1) * step]
            if p != q:
                count += 1
                largest = max(largest, max(abs(i - j) for i, j in zip(p, q)))
                first = first or (x, y)
    if count == 0:
        return "equal pixels, other bytes"
    return f"{count} of {width * len(a)} pixels, by at most {largest}, first at {first[0]},{first[1]}"


def compare_png(old, new, notes):
    """Compares PNGs byte by byte without their text chunks, then the texts."""
    a, b = png_chunks(old), png_chunks(new)
    texts = (b"tEXt", b"iTXt", b"zTXt")
    plain = [chunk for chunk in a if chunk[0] not in texts]
    if plain != [chunk for chunk in b if chunk[0] not in texts]:
        raise Difference(describe_pixels(a, b))
    words, others = png_text(a), png_text(b)
    if words.keys() != others.keys():
        raise Difference(f"text chunks {sorted(words)} and {sorted(others)}")
    for keyword, text in words.items():
        other = others[keyword]
        if text == other:
            continue
        if keyword.endswith("fingerprint"):
            notes.ignore(keyword)
        elif keyword.endswith("figures"):
            compare_json(text, other, notes)
        else:
            compare_without_version(text, other, keyword, notes)
    return b"".join(kind + content for kind, content in plain)


def compare_without_version(old, new, where, notes):
    """Compares two texts but for the version that they name."""
    if VERSION_TEXT.sub(b"vpe", old) != VERSION_TEXT.sub(b"vpe", new):
        raise Difference(f"{where} differs")
    notes.ignore(f"version in {where}")


def compare_jpeg(old, new, notes):
    """Compares JPEGs without comments and metadata, then these but for the version."""

    def split(data):
        kept, metadata, at = [data[:2]], [], 2
        while data[at + 1] != 0xDA:
            (length,) = struct.unpack_from(">H", data, at + 2)
            (metadata if data[at + 1] in (0xE1, 0xFE) else kept).append(data[at : at + 2 + length])
            at += 2 + length
        return b"".join(kept) + data[at:], metadata

    (pixels, texts), (other_pixels, other_texts) = split(old), split(new)
    if pixels != other_pixels or len(texts) != len(other_texts):
        raise Difference("pixels or number of metadata segments")
    for text, other in zip(texts, other_texts):
        compare_without_version(text[4:], other[4:], "metadata", notes)
    return pixels


def tiff_pages(data):
    """Returns the pages of a TIFF or BigTIFF: for each its fields by tag, and its strips or tiles."""
    order = {b"II": "<", b"MM": ">"}.get(data[:2])
    if not order:
        raise Difference("not a TIFF")
    big = struct.unpack_from(order + "H", data, 2)[0] == 43
    pointer, entry = ("Q", 20) if big else ("I", 12)
    (at,) = struct.unpack_from(order + pointer, data, 8 if big else 4)
    sizes = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8}
    sizes.update({13: 4, 16: 8, 17: 8, 18: 8})
    integers = {1: "B", 3: "H", 4: "I", 16: "Q"}
    pages = []
    while at:
        (count,) = struct.unpack_from(order + ("Q" if big else "H"), data, at)
        at += 8 if big else 2
        fields = {}
        for _ in range(count):
            tag, kind, items = struct.unpack_from(order + "HH" + pointer, data, at)
            place = at + 4 + struct.calcsize(order + pointer)
            size = sizes[kind] * items
            if size > struct.calcsize(order + pointer):
                (place,) = struct.unpack_from(order + pointer, data, place)
            raw = data[place : place + size]
            # An unsigned integer may be stored in any width that holds it.
            fields[tag] = ("integers", struct.unpack(order + integers[kind] * items, raw)) if kind in (3, 4, 16) else (kind, raw)
            at += entry
        (at,) = struct.unpack_from(order + pointer, data, at)

        def numbers(tag):
            return fields[tag][1]

        pieces = []
        for offsets, lengths in ((273, 279), (324, 325)):
            if offsets in fields:
                pieces = [data[o : o + n] for o, n in zip(numbers(offsets), numbers(lengths))]
        pages.append((fields, pieces))
    return pages


def compare_tiff(old, new, notes):
    """Compares TIFFs field by field and tile by tile. Offsets and the name of the software do not count."""
    offsets, software, xmp = {273, 324, 330}, 305, 700
    a, b = tiff_pages(old), tiff_pages(new)
    if len(a) != len(b):
        raise Difference(f"{len(a)} and {len(b)} pages")
    content = []
    for number, ((fields, pieces), (other_fields, other_pieces)) in enumerate(zip(a, b)):
        if fields.keys() != other_fields.keys():
            raise Difference(f"page {number}: tags {sorted(fields.keys() ^ other_fields.keys())} in one only")
        for tag, (kind, value) in fields.items():
            other_kind, other = other_fields[tag]
            if tag in offsets or (kind, value) == (other_kind, other):
                continue
            if tag not in (software, xmp):
                raise Difference(f"page {number}: tag {tag}")
            compare_without_version(value, other, f"tag {tag}", notes)
        for index, (piece, other) in enumerate(zip(pieces, other_pieces)):
            if piece != other:
                raise Difference(f"page {number}: strip or tile {index} of {len(pieces)}")
        content += pieces
    return b"".join(content)


# Planet files


def compare_planets(old, new, notes):
    """Compares all rows of two planet files but the program's version and checksums that contain it.

    Returns the content that was compared, and the identity.
    """

    def tables(path):
        db = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
        db.text_factory = bytes
        names = [row[0].decode() for row in db.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        content = {}
        for name in sorted(names):
            columns = [row[1].decode() for row in db.execute(f"PRAGMA table_info({name})")]
            if name == "mesh":  # its id is the order in which threads finished
                columns.remove("id")
            digest, rows = hashlib.sha256(), 0
            order = "1, 2" if len(columns) > 1 else "1"
            if name != "meta":
                for row in db.execute(f"SELECT {', '.join(columns)} FROM {name} ORDER BY {order}"):
                    rows += 1
                    # The text "recipe" of an unfinished planet names the version.
                    digest.update(VERSION_TEXT.sub(b"vpe", row[0]) if name == "recipe" else repr(row).encode())
            content[name] = (columns, rows, digest.hexdigest())
        meta = {key.decode(): value.decode() for key, value in db.execute("SELECT key, value FROM meta")}
        db.close()
        return content, meta

    (a, meta), (b, other_meta) = tables(old), tables(new)
    identity, other = meta.get("identity"), other_meta.get("identity")
    if identity != other:
        raise Difference(f"identity {identity} and {other}")
    for name in sorted(a.keys() | b.keys()):
        if a.get(name) != b.get(name):
            raise Difference(f"table {name}")

    def parsed(values):
        result = {}
        for key, value in values.items():
            try:
                result[key] = json.loads(value) if value[:1] in "[{" else value
            except json.JSONDecodeError:
                result[key] = value
        return result

    compare_objects(parsed(meta), parsed(other_meta), "meta", notes)
    return repr((a, identity)).encode(), identity


COMPARE = {
    ".png": compare_png,
    ".jpg": compare_jpeg,
    ".tif": compare_tiff,
    ".json": compare_json,
    ".jsonl": compare_json,
    ".csv": compare_csv,
    ".flight": compare_text,
    ".txt": compare_text,
    ".toml": compare_toml,
}


def compare_files(old, new, notes):
    """Compares two files. Returns how many bytes were compared, and their hash."""
    if old.suffix == ".vpe":
        content, identity = compare_planets(old, new, notes)
        return old.stat().st_size, f"identity {identity} sha256 {hashlib.sha256(content).hexdigest()[:16]}"
    a, b = old.read_bytes(), new.read_bytes()
    content = a
    if a != b:
        compare = COMPARE.get(old.suffix)
        if not compare:
            raise Difference(f"{len(a)} and {len(b)} bytes")
        content = compare(a, b, notes)
    return len(content), hashlib.sha256(content).hexdigest()[:16]


def compare_folders(old, new, notes):
    """Compares all files of two folders. Returns their number and bytes, and a hash of all."""
    names = sorted(str(p.relative_to(old)) for p in old.rglob("*") if p.is_file())
    others = sorted(str(p.relative_to(new)) for p in new.rglob("*") if p.is_file())
    if names != others:
        raise Difference(f"only in one: {', '.join(sorted(set(names) ^ set(others))[:3])}")
    total, digest = 0, hashlib.sha256()
    for name in names:
        try:
            size, part = compare_files(old / name, new / name, notes)
        except Difference as e:
            raise Difference(f"{name}: {e}") from None
        total += size
        digest.update(f"{name} {part}\n".encode())
    return total, f"{digest.hexdigest()[:16]} {len(names)} files"


def main():
    old, new = Path(sys.argv[1]), Path(sys.argv[2])
    notes = Notes()
    try:
        for path in (old, new):
            if not path.exists():
                raise Difference(f"{path} was not written")
        size, digest = (compare_folders if old.is_dir() else compare_files)(old, new, notes)
    except (Difference, ValueError, IndexError, struct.error, zlib.error, sqlite3.Error) as e:
        print(f"DIFFERS\t{e}")
        return 1
    text = notes.text()
    print(f"{'renamed' if notes.is_renamed() else 'same'}\t{size}/{digest}{'  (' + text + ')' if text else ''}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
