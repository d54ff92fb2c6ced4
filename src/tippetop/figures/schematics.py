"""The drawings that explain the problem: the toy, the Euler angles, the model (the report's Figs. 1 to 3)."""

from tippetop.figures.euler_angles import euler_angles_drawing
from tippetop.figures.model import model_drawing
from tippetop.figures.tippe_top import tippe_top_drawing

__all__ = ["euler_angles_drawing", "model_drawing", "tippe_top_drawing"]
