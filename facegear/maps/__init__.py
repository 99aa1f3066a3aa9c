"""Where a model is unstable: maps over two parameters, and tongues found however narrow.

`stability_map` and `tracing` (which stands on `scanning`), values of a parameter at which a tongue closes (`closing`)
or ends in a tip (`lobes`), derivatives (`sensitivity`, `exponents`), work shared out over processes and kept on
disk (`parallel`). `response_map` has the steady response to forces, where the model is stable.
Public: `stability_map`, `tongues`, `frequency_response`, `response_map`.
"""
