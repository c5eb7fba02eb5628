"""How a field of four-point elements goes from point to point."""


def alternation(values, columns):
    """Of elements in rows of so many columns, four points each, anticlockwise. Two numbers over the range of the field: the mean
    difference of neighbouring points, and how far it goes to and fro along lines of points: the mean of the smaller of two
    differences that follow one another with opposite signs, else 0. Points of one element that have the same value count as
    one."""
    field = {}
    for k, value in enumerate(values):
        element, corner = divmod(k, 4)
        field[2 * (element % columns) + (corner in (1, 2)), 2 * (element // columns) + (corner > 1)] = value
    extent = max(values) - min(values)
    if extent <= 0:
        return ["0", "0"]
    width, height = 2 * columns, len(values) // (2 * columns)
    lines = [[field[x, y] for x in range(width)] for y in range(height)]
    lines += [[field[x, y] for y in range(height)] for x in range(width)]
    apart, to_and_fro = [], []
    for line in lines:
        before = None
        for a, b in zip(line, line[1:]):
            now = b - a
            apart.append(abs(now))
            if abs(now) <= 1e-6 * extent:
                continue
            if before is not None:
                to_and_fro.append(min(abs(now), abs(before)) if now * before < 0 else 0)
            before = now
    mean = lambda numbers: sum(numbers) / len(numbers) / extent if numbers else 0
    return [f"{mean(apart):.4f}", f"{mean(to_and_fro):.4f}"]
