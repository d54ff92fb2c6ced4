"""Write the generated modules of the engine; see `generate`.

``python -m tippetop.page_engine`` writes a module only if its text has changed, so that the page is
built again only then.
"""

import sys

from tippetop.page_engine import HERE
from tippetop.page_engine.generate import generated
from tippetop.support.files import written_beside
from tippetop.translate.refusal import Untranslatable

if __name__ == "__main__":
    try:
        texts = generated()
    except Untranslatable as refusal:
        sys.exit(str(refusal))
    for name, text in texts.items():
        path = HERE / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            with written_beside(path, overwrite=True) as beside:
                beside.write_text(text, encoding="utf-8")
