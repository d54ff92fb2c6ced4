"""Translation of Python modules to JavaScript, statement by statement.

Read `symbols` first: the symbol table of the translated modules. `types` and `inference` infer the
types of expressions, so that a method or a field is found in its class. `expressions`, `calls`,
`statements` and `definitions` translate what their names say, each building on the one before;
`layout` breaks long lines. `runtime_names` lists the names of the JavaScript runtime.

Code without a translation that is known to mean the same is refused with file and line; see
`refusal`. Whether JavaScript means the same depends on types. Where a type is unknown, the runtime
checks the values, and throws rather than return a different result.

Modules state in comments how they are translated; see `declarations`. Above a function, class,
method or constant: ``# translate: skip`` (it has no counterpart), ``# translate: runtime`` (the
runtime has it) or ``# translate: drop`` (statements that only call it are left out). Anywhere in
the module: ``# translate module: numbers`` (or ``arrays``, ``numpy``, ``series``, ``skip``, ``by
hand in file.js``).
"""
