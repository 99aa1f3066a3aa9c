r"""Hsu's averaging derived step by step (section 2.2.2, equations 2-12 to 2-28).

Two modal coordinates k and j of the standard form 2-12 with one harmonic s of the excitation,

    q̈_i + ω_i² q_i = −Σ_j [f⁰_ij + f_ij cos sωt + g_ij sin sωt] q̇_j − Σ_j [d_ij cos sωt + e_ij sin sωt] q_j,

are written with slowly varying amplitudes, averaged over the two fast phases, made autonomous by a rotating
transformation and reduced to a growth rate. Nothing is assumed about which terms survive: a harmonic is a
power of exp(iω_k t), exp(iω_j t) and exp(iΛt), and averaging picks the power zero of the first two.

The small parameter ε is absorbed into the coefficients, and Λ (ε s λ in the text) is the detuning of the s-th
multiple of the parametric frequency ω: sω = ω_k + ω_j + Λ (sum, 2-21), sω = ω_j − ω_k + Λ (difference, j > k), and
sω = 2ω_k + Λ (a single frequency, the sum with k = j). The superscript s of the text is left out.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, Literal

import sympy as sp

Kind = Literal["sum", "difference", "single"]

# Time, the natural frequencies, the detuning Λ and the phase sωt.
TIME: Final = sp.Symbol("t", real=True)
OMEGA: Final = {i: sp.Symbol(f"omega_{i}", positive=True) for i in "kj"}
DETUNING: Final = sp.Symbol("Lambda", real=True)
PARAMETRIC_PHASE: Final = sp.Symbol("Theta", real=True)
# Slow amplitudes A_i, B_i of 2-18, and their complex combinations 2-24.
A: Final = {i: sp.Symbol(f"A_{i}", real=True) for i in "kj"}
B: Final = {i: sp.Symbol(f"B_{i}", real=True) for i in "kj"}
X1, X2, Y1, Y2 = sp.symbols("X_1 X_2 Y_1 Y_2")
# What a pair of coordinates leaves in the criterion: √ of the discriminant has these real and imaginary parts.
PRODUCT_REAL, PRODUCT_IMAG = sp.symbols("P Q", real=True)
DAMPING: Final = {i: sp.Symbol(f"f^0_{i}{i}", real=True) for i in "kj"}

# exp(iω_k t), exp(iω_j t), exp(isωt) and exp(iΛt) while harmonics are being sorted.
_FAST: Final = {i: sp.Symbol(f"u_{i}") for i in "kj"}
_EXCITATION: Final = sp.Symbol("v")
_SLOW: Final = sp.Symbol("p")


def coefficient(letter: str, row: str, column: str) -> sp.Symbol:
    """Entry of a coefficient matrix of 2-14, for example d_kj; ``letter`` is one of d, e, f, g, f^0."""
    return sp.Symbol(f"{letter}_{row}{column}", real=True)


@dataclass(frozen=True)
class Derivation:
    """Every intermediate result of Hsu's method for one kind of resonance.

    Attributes
    ----------
    kind : {"sum", "difference", "single"}
        Which combination of natural frequencies sω is close to.
    right_hand_side : dict
        2-16, per coordinate: what stands right of q̈_i + ω_i² q_i once 2-18 is put in; phases ω_i t and Θ = sωt.
    harmonics : dict
        2-20, per pair (i, j): H1, H2, H3, H4, the amplitudes of cos(ω_j t+Θ), cos(ω_j t−Θ), sin(ω_j t+Θ),
        sin(ω_j t−Θ) in −2 × the right-hand side.
    resonant : dict
        2-22, per coordinate: the part of the right-hand side that oscillates at ω_i within the detuning.
    variation : dict
        The exact variation of A_i and B_i, (Ȧ_i, Ḃ_i), before averaging.
    averaged : dict
        2-23: (Ȧ_i, Ḃ_i) averaged over ω_k t and ω_j t.
    amplitudes : tuple of sympy.Symbol
        Complex amplitudes of 2-24 in the order of the matrices below.
    complex_matrix : sympy.Matrix
        2-25: matrix of the linear equations of ``amplitudes``, with exp(±iΛt) in it.
    autonomous_matrix : sympy.Matrix
        The same after the rotating transformation: constant, two conjugate blocks on the diagonal.
    block : sympy.Matrix
        Its first 2 × 2 block, or for a single frequency the whole matrix.
    characteristic : sympy.Expr
        det(μI − block), the symbol μ being ``sympy.Symbol("mu")``.
    xi, eta : sympy.Expr
        Real and imaginary part of 16 × the discriminant (tr/2)² − det, Γ_r and Γ_i; 2-27 and 2-28 call them α and β.
    growth_rate : sympy.Expr
        Largest real part of μ [1/s]; unstable where it is positive (2-26).
    """

    kind: Kind
    right_hand_side: dict[str, sp.Expr]
    harmonics: dict[tuple[str, str], tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]]
    resonant: dict[str, sp.Expr]
    variation: dict[str, tuple[sp.Expr, sp.Expr]]
    averaged: dict[str, tuple[sp.Expr, sp.Expr]]
    amplitudes: tuple[sp.Symbol, ...]
    complex_matrix: sp.Matrix
    autonomous_matrix: sp.Matrix
    block: sp.Matrix
    characteristic: sp.Expr
    xi: sp.Expr
    eta: sp.Expr
    growth_rate: sp.Expr

    def steps(self) -> tuple[tuple[str, str, sp.Expr], ...]:
        """Return (equation number, what it is, equation) in the order of the derivation, to be printed."""
        rows: list[tuple[str, str, sp.Expr]] = []
        for i, expression in self.right_hand_side.items():
            acceleration = sp.Symbol(rf"{{\ddot q_{i} + \omega_{i}^2 q_{i}}}")
            rows.append(("2-16", f"equation of motion of coordinate {i}", sp.Eq(acceleration, expression)))
        for (i, j), amplitudes in self.harmonics.items():
            for index, expression in enumerate(amplitudes, start=1):
                rows.append(
                    (
                        "2-20",
                        f"harmonic amplitude, {i}{j}",
                        sp.Eq(sp.Symbol(f"H_{index}^{i}{j}"), expression),
                    )
                )
        for i, expression in self.resonant.items():
            rows.append(
                ("2-22", f"near-resonant part, coordinate {i}", sp.Eq(sp.Symbol(f"R_{i}"), expression))
            )
        for i, pair in self.averaged.items():
            for symbol, expression in zip((A[i], B[i]), pair, strict=True):
                rows.append(("2-23", "averaged variation", sp.Eq(_rate(symbol), expression)))
        vector = sp.Matrix(self.amplitudes)
        derivatives = sp.Matrix([_rate(a) for a in self.amplitudes])
        rows.append(("2-25", "complex amplitudes", sp.Eq(derivatives, self.complex_matrix * vector)))
        rows.append(("2-25", "autonomous matrix", self.autonomous_matrix))
        rows.append(("2-26", "characteristic equation", sp.Eq(self.characteristic, 0)))
        number = "2-28" if self.kind == "difference" else "2-27"
        rows.append((number, "Γ_r", sp.Eq(sp.Symbol("Gamma_r"), self.xi)))
        rows.append((number, "Γ_i", sp.Eq(sp.Symbol("Gamma_i"), self.eta)))
        rows.append(("2-26", "growth rate", sp.Eq(sp.Symbol("sigma"), self.growth_rate)))
        return tuple(rows)


def _rate(amplitude: sp.Symbol) -> sp.Symbol:
    """Symbol printed as the amplitude with a dot."""
    return sp.Symbol(rf"{{\dot {amplitude.name}}}")


def _phase(base: sp.Symbol) -> sp.Symbol:
    """Real phase whose exponential the bookkeeping symbol stands for."""
    phases = {_FAST["k"]: OMEGA["k"] * TIME, _FAST["j"]: OMEGA["j"] * TIME}
    return (phases | {_EXCITATION: PARAMETRIC_PHASE, _SLOW: DETUNING * TIME})[base]


def _cos(power: sp.Expr) -> sp.Expr:
    return (power + 1 / power) / 2


def _sin(power: sp.Expr) -> sp.Expr:
    return (power - 1 / power) / (2 * sp.I)


def _product(one: sp.Expr, other: sp.Expr) -> sp.Expr:
    """Multiply two expanded sums term by term; SymPy's own ``expand`` looks for much that is not in them."""
    return sp.Add(*(a * b for a in sp.Add.make_args(one) for b in sp.Add.make_args(other)))


def _real_form(expression: sp.Expr) -> sp.Expr:
    """Sum of cosines and sines equal to an expanded Laurent polynomial with conjugate coefficients."""
    bases = (_FAST["k"], _FAST["j"], _EXCITATION, _SLOW)
    shift = 4  # More than any power that occurs, so that the product with it is a polynomial.
    polynomial = sp.Poly(_product(expression, sp.Mul(*(base**shift for base in bases))), *bases, expand=False)
    factors = {tuple(power - shift for power in powers): factor for powers, factor in polynomial.terms()}
    total = sp.S.Zero
    for powers, factor in factors.items():
        opposite = tuple(-power for power in powers)
        if next((power for power in reversed(powers) if power), 1) < 0 and opposite in factors:
            continue  # Collected with its conjugate.
        phase = sum((power * _phase(base) for power, base in zip(powers, bases, strict=True)), sp.S.Zero)
        if phase == 0:
            total += sp.expand(factor)
            continue
        conjugate = factors.get(opposite, sp.S.Zero)
        total += sp.expand(factor + conjugate) * sp.cos(phase)
        total += sp.expand(sp.I * (factor - conjugate)) * sp.sin(phase)
    return total


def _coefficients(expression: sp.Expr, base: sp.Expr, power: int) -> sp.Expr:
    """Return what stands by a power in an expanded sum."""
    return expression.coeff(base, power)


def _forcing(i: str, coordinates: str) -> sp.Expr:
    """Right-hand side of 2-16 with 2-18 put in, as a Laurent polynomial in the exponentials."""
    total = sp.S.Zero
    cos_s, sin_s = _cos(_EXCITATION), _sin(_EXCITATION)
    for j in coordinates:
        position = A[j] * _cos(_FAST[j]) + B[j] * _sin(_FAST[j])
        velocity = OMEGA[j] * (-A[j] * _sin(_FAST[j]) + B[j] * _cos(_FAST[j]))
        entry = {letter: coefficient(letter, i, j) for letter in ("d", "e", "f", "g", "f^0")}
        total -= (entry["f^0"] + entry["f"] * cos_s + entry["g"] * sin_s) * velocity
        total -= (entry["d"] * cos_s + entry["e"] * sin_s) * position
    return sp.expand(total)


def _harmonic_amplitudes(forcing: sp.Expr, j: str) -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]:
    """H1…H4 of 2-20: amplitudes of cos and sin of ω_j t ± Θ in −2 × the forcing."""
    pairs = []
    for sign in (1, -1):
        up, down = (
            _coefficients(_coefficients(-2 * forcing, _FAST[j], power), _EXCITATION, sign * power)
            for power in (1, -1)
        )
        pairs.append((sp.expand(up + down), sp.expand(sp.I * (up - down))))
    (h1, h3), (h2, h4) = pairs
    return h1, h2, h3, h4


def _mean(expression: sp.Expr, coordinates: str) -> sp.Expr:
    """Average over the fast phases: the power zero of their exponentials."""
    for i in coordinates:
        expression = _coefficients(expression, _FAST[i], 0)
    return expression


@lru_cache(maxsize=3)
def derive(kind: Kind) -> Derivation:
    """Derive Hsu's averaged equations and stability criterion (2-16 to 2-28).

    Parameters
    ----------
    kind : {"sum", "difference", "single"}
        sω ≈ ω_k + ω_j, sω ≈ ω_j − ω_k with j > k, or sω ≈ 2ω_k.

    Returns
    -------
    Derivation
        The same object at each call; a fraction of a second the first time.

    Raises
    ------
    ValueError
        If ``kind`` is none of the three.
    """
    excitations = {
        "sum": _FAST["k"] * _FAST["j"] * _SLOW,
        "difference": _FAST["j"] / _FAST["k"] * _SLOW,
        "single": _FAST["k"] ** 2 * _SLOW,
    }
    if kind not in excitations:
        raise ValueError(f"kind = {kind!r}: valid are 'sum', 'difference' and 'single'")
    coordinates = "k" if kind == "single" else "kj"
    excitation = excitations[kind]

    forcing = {i: _forcing(i, coordinates) for i in coordinates}
    harmonics = {}
    for i in coordinates:
        for j in coordinates:
            others = [A[n] for n in coordinates if n != j] + [B[n] for n in coordinates if n != j]
            alone = forcing[i].subs(dict.fromkeys(others, 0))
            harmonics[i, j] = _harmonic_amplitudes(alone, j)

    resonant, variation, averaged = {}, {}, {}
    for i in coordinates:
        tuned = forcing[i].subs(_EXCITATION, excitation)
        near = sum(
            (
                _product(_mean(_coefficients(tuned, _FAST[i], m), coordinates.replace(i, "")), _FAST[i] ** m)
                for m in (1, -1)
            ),
            sp.S.Zero,
        )
        resonant[i] = _real_form(near)
        # Variation of parameters: Ȧ cos ω_i t + Ḃ sin ω_i t = 0 and ω_i(−Ȧ sin ω_i t + Ḃ cos ω_i t) = forcing.
        cosine, sine = _cos(_FAST[i]), _sin(_FAST[i])
        rates = sp.Matrix([[cosine, -sine], [sine, cosine]]) * sp.Matrix([0, 1]) / OMEGA[i]
        exact = [_product(sp.expand(rate), tuned) for rate in rates]
        variation[i] = (_real_form(exact[0]), _real_form(exact[1]))
        averaged[i] = (_mean(exact[0], coordinates), _mean(exact[1], coordinates))

    amplitudes, matrix = _complex_amplitudes(kind, averaged)
    size = len(amplitudes) // 2
    autonomous = _autonomous(matrix)
    block = autonomous if kind == "single" else autonomous[:size, :size]
    mu = sp.Symbol("mu")
    xi, eta = _discriminant(block)
    damping = sp.expand(-2 * block.trace())
    return Derivation(
        kind=kind,
        right_hand_side={i: _real_form(forcing[i]) for i in coordinates},
        harmonics=harmonics,
        resonant=resonant,
        variation=variation,
        averaged={i: (_real_form(pair[0]), _real_form(pair[1])) for i, pair in averaged.items()},
        amplitudes=amplitudes,
        complex_matrix=matrix.applyfunc(lambda entry: entry.subs(_SLOW, sp.exp(sp.I * DETUNING * TIME))),
        autonomous_matrix=autonomous,
        block=block,
        characteristic=sp.collect(sp.expand((mu * sp.eye(2) - block).det()), mu),
        xi=xi,
        eta=eta,
        growth_rate=(_real_root(xi, eta) - damping) / 4,
    )


def _complex_amplitudes(kind: Kind, averaged: dict[str, Any]) -> tuple[tuple[sp.Symbol, ...], sp.Matrix]:
    """2-24 and 2-25, the amplitudes ordered so that those that act on each other are neighbours."""
    names = {"k": (X1, X2), "j": (Y1, Y2)}
    # A = (X1 + X2)/2 and B = (X1 − X2)/(2i), likewise for j.
    back = {A[i]: sum(names[i]) / 2 for i in averaged}
    back |= {B[i]: (names[i][0] - names[i][1]) / (2 * sp.I) for i in averaged}
    rate = {}
    for i, (first, second) in averaged.items():
        rate[names[i][0]] = sp.expand((first + sp.I * second).subs(back))
        rate[names[i][1]] = sp.expand((first - sp.I * second).subs(back))
    order = {"single": (X1, X2), "sum": (X1, Y2, X2, Y1), "difference": (X2, Y2, X1, Y1)}[kind]
    matrix = sp.Matrix([[sp.factor_terms(rate[row].coeff(column)) for column in order] for row in order])
    return order, matrix


def _autonomous(matrix: sp.Matrix) -> sp.Matrix:
    """Turn each pair of neighbours by half the detuning so that exp(±iΛt) leaves the equations."""
    size = matrix.shape[0]
    turns = []
    for first in range(0, size, 2):
        entry = sp.expand(matrix[first, first + 1])
        power = next(m for m in (1, -1) if entry.coeff(_SLOW, m) != 0)
        turns += [sp.Rational(power, 2), -sp.Rational(power, 2)]
    # With X = x exp(i r Λt): ẋ = Σ M exp(i(r_n − r_m)Λt) x_n − i r_m Λ x_m.
    turned = sp.Matrix(size, size, lambda m, n: sp.expand(matrix[m, n] * _SLOW ** (turns[n] - turns[m])))
    result = turned - sp.diag(*(sp.I * turn * DETUNING for turn in turns))
    if result.has(_SLOW):
        raise ArithmeticError("the rotating transformation left exp(iΛt) in the averaged equations")
    return result


def _discriminant(block: sp.Matrix) -> tuple[sp.Expr, sp.Expr]:
    """ξ + iη = 16[(tr/2)² − det] = 4(difference of the diagonal)² + 16 × (product off the diagonal)."""
    left, right = sp.expand(block[0, 0] - block[1, 1]).as_real_imag()
    xi, eta = 4 * sp.factor(left**2) - 4 * right**2, 8 * left * right
    (a, b), (c, d) = (
        tuple(sp.factor(part) for part in sp.expand(4 * entry).as_real_imag())
        for entry in (block[0, 1], block[1, 0])
    )
    eta_product = sp.S.Zero if sp.expand(b * c + a * d) == 0 else b * c + a * d
    return xi + sp.factor_terms(a * c - b * d), sp.factor_terms(eta) + sp.factor_terms(eta_product)


def _real_root(xi: sp.Expr, eta: sp.Expr) -> sp.Expr:
    """Real part of √(ξ + iη): the non-negative p of (p + iq)² = ξ + iη."""
    square, u, v = sp.symbols("p_2 u v", real=True)
    # q = v/(2p) in p² − q² = u leaves a quadratic in p², whose larger root is never negative.
    roots = sp.solve(square**2 - u * square - v**2 / 4, square)
    larger = next(root for root in roots if root.subs({u: 1, v: 1}) > 0)
    return sp.sqrt(sp.factor(larger)).subs({u: xi, v: eta})


@lru_cache(maxsize=1)
def border_detunings() -> tuple[sp.Expr, sp.Expr]:
    """Detunings Λ at which the growth rate vanishes, in closed form.

    With P + iQ for the part of ξ + iη that comes from the excitation, σ = 0 means that
    p = f⁰_kk + f⁰_jj solves (p + iq)² = ξ + iη, which is a quadratic equation in Λ.

    Returns
    -------
    tuple of sympy.Expr
        Lower and upper Λ [rad/s] for positive f⁰_kk and f⁰_jj, in the symbols ``DAMPING``, ``PRODUCT_REAL``
        and ``PRODUCT_IMAG``; complex where the resonance is stable at every detuning.
    """
    f_k, f_j = DAMPING["k"], DAMPING["j"]
    p = f_k + f_j
    xi, eta = pair_discriminant()
    condition = sp.expand(4 * p**4 - 4 * xi * p**2 - eta**2)
    polynomial = sp.Poly(condition, DETUNING)
    square, linear, constant = (sp.factor(c) for c in polynomial.all_coeffs())
    # The damping is positive, so that √p² = p.
    root = sp.sqrt(sp.factor(linear**2 - 4 * square * constant)).replace(sp.Abs, lambda x: x)
    lower, upper = (sp.cancel((-linear - sign * root) / (2 * square)) for sign in (1, -1))
    return lower, upper


def pair_discriminant() -> tuple[sp.Expr, sp.Expr]:
    """ξ and η of any 2 × 2 block, P + iQ being 16 × the product of its off-diagonal entries."""
    f_k, f_j = DAMPING["k"], DAMPING["j"]
    diagonal = (-f_k / 2 + sp.I * DETUNING / 2, -f_j / 2 - sp.I * DETUNING / 2)
    product = (PRODUCT_REAL + sp.I * PRODUCT_IMAG) / 16
    return _discriminant(sp.Matrix([[diagonal[0], product], [1, diagonal[1]]]))


def arguments(kind: Kind) -> tuple[sp.Symbol, ...]:
    """Symbols of ``derive(kind).growth_rate``: arguments of ``criterion.growth_rate_function(kind)`` in order."""
    coordinates = "k" if kind == "single" else "kj"
    pairs = ("kk",) if kind == "single" else ("kj", "jk")
    symbols = [OMEGA[i] for i in coordinates] + [DETUNING] + [DAMPING[i] for i in coordinates]
    return tuple(symbols + [coefficient(letter, *pair) for pair in pairs for letter in "defg"])
