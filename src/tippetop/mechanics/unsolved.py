"""What the mechanics says where it finds no answer."""


class Unsolved(ArithmeticError):
    """There is no answer, or none is found; it says why, in words for those who launched the top."""
