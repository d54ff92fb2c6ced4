"""The laboratory: a page where anyone launches the top. Physics stays here; the browser draws."""
