"""Stability-based design: what a body, its teeth, its power and its pinions may be.

Critical thickness and the flow of Fig. 4.6 (`body`), families of drives and root stress (`teeth`), critical power and
the envelope of safe powers (`envelope`), positions of pinions that silence a tongue (`cancellation`), what to change
first (`changes`); losses told from measured exponents (`measurements`,
`identification`) by least squares (`fits`), a damaged tooth
from the response (`tooth_search`).
Public: `critical_thickness`.
"""
