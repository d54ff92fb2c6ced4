"""Contact modes: how the top moves in each, what ends it, and what follows."""
