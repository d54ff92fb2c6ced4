"""Variables of flags: numbers with CF's flag_meanings in files, words in datasets."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.results.catalogue import Variable


def flag_words(numbers: NDArray[Any], meanings: str) -> NDArray[np.str_]:
    """Return the word of each number, by CF's flag_meanings; "" for other numbers."""
    words = np.array([*meanings.split(), ""])
    return np.asarray(words[np.where((numbers >= 0) & (numbers < len(words)), numbers, -1)])


def worded(variable: Variable) -> dict[str, Any]:
    """Return the attributes of a variable whose flags are words."""
    return {name: value for name, value in variable.attributes.items() if name != "flag_values"}


def decoded(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the numbers of flags replaced by words.

    The attribute flag_meanings stays and lists the words; flag_values is removed. Lazy arrays are
    decoded when they are read.
    """
    words = dict[Any, xr.DataArray]()
    for name, variable in dataset.data_vars.items():
        if not _has_flags(variable) or not np.issubdtype(variable.dtype, np.integer):
            continue
        meanings = variable.attrs["flag_meanings"]
        longest = max(map(len, meanings.split()))
        words[name] = xr.apply_ufunc(
            flag_words,
            variable,
            kwargs={"meanings": meanings},
            dask="parallelized",
            output_dtypes=[np.dtype(f"<U{longest}")],
        )
        words[name].attrs = {
            key: value for key, value in variable.attrs.items() if key != "flag_values"
        }
    return dataset.assign(words)


def encoded(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the words of flags replaced by numbers, "" by -1."""
    numbers = dict[Any, xr.DataArray]()
    for name, variable in dataset.data_vars.items():
        if not _has_flags(variable) or np.issubdtype(variable.dtype, np.integer):
            continue
        words = variable.attrs["flag_meanings"].split()
        codes = np.full(variable.shape, -1, dtype=np.int8)
        for number, word in enumerate(words):
            codes[variable.values == word] = number
        values = np.arange(len(words), dtype=np.int8)
        numbers[name] = variable.copy(data=codes).assign_attrs(flag_values=values)
    return dataset.assign(numbers)


def _has_flags(variable: xr.DataArray) -> bool:
    return "flag_meanings" in variable.attrs
