"""The protocol of bench/peers.pl, for the platforms in Python."""

TEXT = "0123456789" * 10


def tell(fact):
    print(fact + ".", flush=True)
    input()


class measured:
    """with measured(Measure, Count): what is measured"""

    def __init__(self, measure, count):
        self.fact = f"done({measure}, {count})"

    def __enter__(self):
        tell("begin")

    def __exit__(self, kind, *_):
        if kind is None:
            tell(self.fact)
