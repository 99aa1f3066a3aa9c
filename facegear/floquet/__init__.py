"""The engine: stability of linear systems with periodic coefficients (chapter 2). It knows nothing of gears.

Systems: `periodic` has the equations, `loads` what varies in them, `load_columns` its parameters for many values,
`rigid_motion` what meets no load, `piecewise`, `fourier` and `series` the series they are made of; `models` says what
makes a system at each speed, `modified_models` are made of others.

Multipliers: `multipliers` are those of the transition matrix by one of the `methods`; `error_estimates` tell how well
they are known. `collocation` takes `free_systems` in their `free_modes`, the panels of `gauss_panels` and the equations
of `contact_forces`; the others are `stepping`, `radau` and `taylor`. `columns`, `multiplier_curves` and `sheets` have
the matrix along a parameter, along speed and along both. `eigenvalues` and `eigenvectors` are those of many matrices,
in `lockstep` and `lockstep_vectors` where Numba is installed (`compiled`), as `lockstep_exponentials` and
`lockstep_taylor` have steps of small systems.

Modes and approximations: `modes` has natural motions, `labels` names what is unstable; `modal` is the standard form for
`averaging` and `hsu`, along speed `band_speeds`, and `hill` has the harmonic balance.

Motions: `response` has the steady one that forces cause, along the panels of `motion`. Systems whose loads act in
contact only are those of `clearance`: `orbits` has their periodic motions, each a `contact_motion` with one of the
`contact_patterns`, for which `contact_panels` has the equations; `continuation` follows the `branches` of these along a
parameter, by steps of `arc_length`, `transients` has where other motions end, compiled in `lockstep_transients` where
Numba is installed.

What each method takes, and what it costs. The state *jumps* where the slope of a shape jumps under a mass that follows
it, and where a system says so; a load whose strength varies, mass included, has a *weight*; *overdamped* and *rigid*
modes do not oscillate; *sensitivities* are the derivatives of :mod:`facegear.maps.sensitivity`. Without a name
:func:`facegear.floquet.methods.with_method` takes `Collocation`, and `AdaptiveMagnus` where that does not apply;
maps of small systems take `Taylor`.

===============  =====  ==========  =====  =======  =============  =====  ==========================================
method           jumps  overdamped  rigid  weights  sensitivities  order  cost
===============  =====  ==========  =====  =======  =============  =====  ==========================================
Stepwise         no     yes         yes    yes      yes            1      an exponential of 2n rows a sub-interval
AlignedStepwise  yes    yes         yes    yes      yes            2      as Stepwise
Magnus           yes    yes         yes    yes      yes            4      as Stepwise, two evaluations
AdaptiveMagnus   yes    yes         yes    yes      yes            10     Magnus thrice or more, dear if overdamped
Collocation      yes    no          yes    yes      no             32     16 equations a load and panel, the least
Radau            yes    yes         yes    yes      no             31     16 n equations a panel, best if overdamped
Taylor           no     yes         yes    no       no             any    a recurrence, of many small systems the least
===============  =====  ==========  =====  =======  =============  =====  ==========================================

The order holds at jumps of A(t) too. That of Stepwise is 2 where there are none; of Collocation and Radau it is that of
the default number of nodes, at the end of a panel; series of Taylor end when their terms have become small, and may
have loads with a weight but without a mass.
Public: `PeriodicSystem`, `ContactLoad`, `PiecewiseChebyshev`, `transition_matrix`, `multipliers`, `growth_rate`,
`error_estimate`, `steady_response`, `Excited`, `WithoutRigidMotion`, `replace_parameter`, `resonance_bands`.
"""
