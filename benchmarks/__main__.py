"""`python -m benchmarks`."""

from benchmarks.bench_simulate import main

if __name__ == "__main__":
    main()
