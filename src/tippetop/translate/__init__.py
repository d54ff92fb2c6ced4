"""Python modules translated to JavaScript, statement by statement.

Read `program` first: the symbol table of the modules that are translated. `definitions`,
`statements`, `calls` and `expressions` translate what their names say, each building on the next;
`layout` breaks long lines.
"""
