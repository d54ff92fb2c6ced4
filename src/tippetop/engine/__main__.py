"""Write the engine's generated modules; see `tippetop.engine.generate`."""

from tippetop.engine import HERE
from tippetop.engine.generate import generated

if __name__ == "__main__":
    for name, text in generated().items():
        (HERE / name).write_text(text, encoding="utf-8")
