"""Tables of results: comma-separated values (RFC 4180) with one header of "name[unit]" columns. The one reader of all scripts
of the evidence."""
import csv
import math


class Table:
    """heads: columns as they are written; rows: texts by name without unit."""

    def __init__(self, path):
        with open(path, newline="", encoding="utf-8") as file:
            records = [record for record in csv.reader(file) if record]
        self.heads = records[0] if records else []
        names = [name_of(head) for head in self.heads]
        self.rows = [dict(zip(names, record)) for record in records[1:]]

    def texts(self, name):
        return [row[name] for row in self.rows]

    def numbers(self, name):
        return [float(text) for text in self.texts(name)]


def name_of(head):
    return head.split("[")[0]


def shown(number):
    """In six digits, whole numbers without a point."""
    return f"{number:.0f}" if number == int(number) else f"{number:.6g}"


def at_share(texts, share):
    """What this share of the numbers does not exceed."""
    return sorted(texts, key=float)[math.ceil(share * len(texts)) - 1]
