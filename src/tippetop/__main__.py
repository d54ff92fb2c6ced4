"""``python -m tippetop``: the command line, where its script is not on the path."""

from tippetop.cli.main import main

if __name__ == "__main__":
    main()
