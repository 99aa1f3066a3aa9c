"""The engine: stability of linear systems with periodic coefficients (chapter 2). It knows nothing of gears.

`periodic` has the systems and their rank-one loads, `piecewise` and `series` the series they are made of;
`multipliers` the transition matrix by the methods of `collocation`, `stepping` and `radau`, `columns` and
`multiplier_curves` the same along a parameter and along speed; `labels` names what is unstable; `modal`, `averaging`,
`hsu` are the approximations.
Public: `PeriodicSystem`, `ContactLoad`, `PiecewiseChebyshev`, `transition_matrix`, `multipliers`, `growth_rate`,
`error_estimate`, `WithoutRigidMotion`, `replace_parameter`, `resonance_bands`.
"""
