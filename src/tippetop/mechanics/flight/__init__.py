"""Free flight: see `free_motion`."""
