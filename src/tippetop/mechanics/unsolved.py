"""What the mechanics says where it finds no solution."""


class Unsolved(ArithmeticError):
    """There is no solution, or none is found; it says why, in words for those who launched the
    top.
    """
