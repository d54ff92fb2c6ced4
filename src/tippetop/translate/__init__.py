"""Python modules translated to JavaScript, statement by statement.

Read `program` first: the symbol table of the translated modules. `types` and `inference` tell the
types of expressions, so that a method or field is that of its class. `definitions`, `statements`,
`calls` and `expressions` translate what their names say, each building on the next; `layout` breaks
long lines. `runtime_names` lists what the JavaScript runtime has.

What has no translation that is known to mean the same is refused with file and line, as `refusal`
says. Whether JavaScript means the same depends on types; where they are unknown, the runtime looks
at the values and throws rather than return something else.

Modules say in comments how they are translated, see `declarations`: above a function, class, method
or constant ``# translate: skip`` (it has no counterpart), ``# translate: runtime`` (the runtime has
it) or ``# translate: drop`` (calls that stand alone are left out); anywhere in the module
``# translate module: numbers`` (or ``arrays``, ``series``, ``skip``, ``by hand in file.js``).
"""
