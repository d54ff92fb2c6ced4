"""Bodies as a lathe makes them: profiles, what they weigh, what they touch the table with."""
