"""Write the engine's generated modules; see `tippetop.page_engine.generate`."""

from tippetop.page_engine import HERE
from tippetop.page_engine.generate import generated

if __name__ == "__main__":
    for name, text in generated().items():
        (HERE / name).write_text(text, encoding="utf-8")
