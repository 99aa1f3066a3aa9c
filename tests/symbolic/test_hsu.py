import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.symbolic import criterion, hsu

KINDS = ("sum", "difference", "single")
CHECK = settings(deadline=None, derandomize=True, max_examples=50)


def symbol(letter, pair):
    return hsu.coefficient(letter, *pair)


def values_of(expressions, seed):
    """Random numbers for every symbol of the expressions, natural frequencies well apart."""
    rng = np.random.default_rng(seed)
    symbols = set().union(*(e.free_symbols for e in expressions))
    values = {s: rng.normal() for s in sorted(symbols, key=str)}
    return values | {hsu.OMEGA["k"]: 1.3 + rng.random(), hsu.OMEGA["j"]: 3.1 + rng.random()}


def close(expression, target):
    return sp.simplify(sp.expand(expression - target)) == 0


@pytest.mark.parametrize("kind", KINDS)
def test_right_hand_side_is_that_of_2_16_with_2_18_put_in(kind):
    derivation = hsu.derive(kind)
    coordinates = "k" if kind == "single" else "kj"
    for i in coordinates:
        expression = derivation.right_hand_side[i]
        direct = sp.S.Zero
        psi = hsu.PARAMETRIC_PHASE
        for j in coordinates:
            phase = hsu.OMEGA[j] * hsu.TIME
            q = hsu.A[j] * sp.cos(phase) + hsu.B[j] * sp.sin(phase)
            y = hsu.OMEGA[j] * (-hsu.A[j] * sp.sin(phase) + hsu.B[j] * sp.cos(phase))
            f, g, d, e = (symbol(letter, i + j) for letter in "fgde")
            direct -= (symbol("f^0", i + j) + f * sp.cos(psi) + g * sp.sin(psi)) * y
            direct -= (d * sp.cos(psi) + e * sp.sin(psi)) * q
        for seed in range(3):
            values = values_of([expression, direct], seed)
            assert float(expression.subs(values)) == pytest.approx(float(direct.subs(values)), abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_harmonics_are_the_printed_ones_of_2_20(kind):
    for (i, j), (h1, h2, h3, h4) in hsu.derive(kind).harmonics.items():
        d, e, f, g = (symbol(letter, i + j) for letter in "defg")
        a, b, w = hsu.A[j], hsu.B[j], hsu.OMEGA[j]
        assert close(h1, d * a - e * b + f * w * b + g * w * a)
        assert close(h2, d * a + e * b + f * w * b - g * w * a)
        assert close(h3, d * b + e * a - f * w * a + g * w * b)
        assert close(h4, d * b - e * a - f * w * a - g * w * b)


def test_resonant_part_of_the_sum_is_the_printed_one_of_2_22():
    derivation = hsu.derive("sum")
    for i, j in ("kj", "jk"):
        _, h2, _, h4 = derivation.harmonics[i, j]
        fast = hsu.OMEGA[i] * hsu.TIME
        turned = fast + hsu.DETUNING * hsu.TIME
        printed = -(h2 * sp.cos(turned) - h4 * sp.sin(turned)) / 2
        printed -= symbol("f^0", i + i) * hsu.OMEGA[i] * (hsu.B[i] * sp.cos(fast) - hsu.A[i] * sp.sin(fast))
        assert close(derivation.resonant[i], printed)


@pytest.mark.parametrize("kind", KINDS)
def test_averages_equal_quadrature_over_the_fast_phases(kind):
    # A trigonometric polynomial is averaged exactly by equally spaced points. The phases run through Λt = slow.
    derivation = hsu.derive(kind)
    slow = 0.7
    theta_k, theta_j = np.meshgrid(*2 * [2 * np.pi * np.arange(16) / 16])
    excitation = {"sum": theta_k + theta_j, "difference": theta_j - theta_k, "single": 2 * theta_k}[
        kind
    ] + slow
    coordinates = "k" if kind == "single" else "kj"
    theta = {"k": theta_k, "j": theta_j}
    for i in coordinates:
        values = values_of([derivation.right_hand_side[i], *derivation.averaged[i]], 5) | {hsu.TIME: 1.0}
        values[hsu.DETUNING] = slow
        forcing = np.zeros_like(theta_k)
        for j in coordinates:
            a, b, w = (values[s] for s in (hsu.A[j], hsu.B[j], hsu.OMEGA[j]))
            d, e, f, g, f0 = (values[symbol(letter, i + j)] for letter in ("d", "e", "f", "g", "f^0"))
            q = a * np.cos(theta[j]) + b * np.sin(theta[j])
            y = w * (-a * np.sin(theta[j]) + b * np.cos(theta[j]))
            forcing -= (f0 + f * np.cos(excitation) + g * np.sin(excitation)) * y
            forcing -= (d * np.cos(excitation) + e * np.sin(excitation)) * q
        rate_a = np.mean(-np.sin(theta[i]) * forcing) / values[hsu.OMEGA[i]]
        rate_b = np.mean(np.cos(theta[i]) * forcing) / values[hsu.OMEGA[i]]
        for rate, expression in zip((rate_a, rate_b), derivation.averaged[i], strict=True):
            assert float(expression.subs(values)) == pytest.approx(rate, abs=1e-13)


def test_coupling_of_the_mean_damping_averages_out():
    for kind in ("sum", "difference"):
        for pair in hsu.derive(kind).averaged.values():
            assert not any(expression.has(symbol("f^0", "kj"), symbol("f^0", "jk")) for expression in pair)


def test_complex_amplitudes_of_the_sum_are_the_printed_ones_of_2_25():
    derivation = hsu.derive("sum")
    f0 = {i: symbol("f^0", i + i) for i in "kj"}
    turn = sp.exp(sp.I * hsu.DETUNING * hsu.TIME)
    w_k, w_j = hsu.OMEGA["k"], hsu.OMEGA["j"]
    p_kj = sp.I * (symbol("d", "kj") - symbol("g", "kj") * w_j) - (
        symbol("e", "kj") + symbol("f", "kj") * w_j
    )
    p_jk = sp.I * (symbol("d", "jk") - symbol("g", "jk") * w_k) - (
        symbol("e", "jk") + symbol("f", "jk") * w_k
    )
    printed = {
        hsu.X1: {hsu.X1: -f0["k"] / 2, hsu.Y2: -p_kj / (4 * w_k) / turn},
        hsu.X2: {hsu.X2: -f0["k"] / 2, hsu.Y1: -sp.conjugate(p_kj) / (4 * w_k) * turn},
        hsu.Y1: {hsu.Y1: -f0["j"] / 2, hsu.X2: -p_jk / (4 * w_j) / turn},
        hsu.Y2: {hsu.Y2: -f0["j"] / 2, hsu.X1: -sp.conjugate(p_jk) / (4 * w_j) * turn},
    }
    for row, amplitude in enumerate(derivation.amplitudes):
        for column, other in enumerate(derivation.amplitudes):
            assert close(derivation.complex_matrix[row, column], printed[amplitude].get(other, 0))


def test_criterion_is_that_of_2_26_to_2_28_with_the_signs_restored():
    w_k, w_j, detuning = hsu.OMEGA["k"], hsu.OMEGA["j"], hsu.DETUNING
    f_k, f_j = symbol("f^0", "kk"), symbol("f^0", "jj")
    a_kj = symbol("d", "kj") - w_j * symbol("g", "kj")
    b_kj = symbol("e", "kj") + w_j * symbol("f", "kj")
    a_jk = symbol("d", "jk") - w_k * symbol("g", "jk")
    b_jk = symbol("e", "jk") + w_k * symbol("f", "jk")
    total = hsu.derive("sum")
    assert close(total.xi, (f_k - f_j) ** 2 - 4 * detuning**2 + (a_kj * a_jk + b_kj * b_jk) / (w_k * w_j))
    assert close(total.eta, 4 * detuning * (f_j - f_k) + (b_kj * a_jk - a_kj * b_jk) / (w_k * w_j))
    a_jk = symbol("d", "jk") + w_k * symbol("g", "jk")
    b_jk = symbol("e", "jk") - w_k * symbol("f", "jk")
    difference = hsu.derive("difference")
    assert close(
        difference.xi, (f_k - f_j) ** 2 - 4 * detuning**2 - (a_kj * a_jk + b_kj * b_jk) / (w_k * w_j)
    )
    assert close(difference.eta, 4 * detuning * (f_j - f_k) + (a_kj * b_jk - b_kj * a_jk) / (w_k * w_j))
    for derivation in (total, difference):
        xi, eta = derivation.xi, derivation.eta
        assert close(derivation.growth_rate, (sp.sqrt((sp.sqrt(xi**2 + eta**2) + xi) / 2) - f_k - f_j) / 4)


def test_single_frequency_is_the_sum_of_a_frequency_with_itself():
    equal = {
        symbol(letter, pair): symbol(letter, "kk")
        for letter in ("d", "e", "f", "g", "f^0")
        for pair in ("kj", "jk", "jj")
    }
    equal[hsu.OMEGA["j"]] = hsu.OMEGA["k"]
    single, total = hsu.derive("single"), hsu.derive("sum")
    assert close(single.xi, total.xi.subs(equal))
    assert single.eta == 0
    assert close(total.eta.subs(equal), 0)


@pytest.mark.parametrize("kind", KINDS)
def test_growth_rate_is_the_largest_real_part_of_the_autonomous_system(kind):
    derivation = hsu.derive(kind)
    function = criterion.growth_rate_function(kind)
    arguments = hsu.arguments(kind)
    matrix = sp.lambdify(arguments, derivation.autonomous_matrix, "numpy")
    rng = np.random.default_rng(3)
    for _ in range(20):
        values = rng.normal(size=len(arguments))
        values[: 1 if kind == "single" else 2] = 1.0 + rng.random(1 if kind == "single" else 2)
        eigenvalues = np.linalg.eigvals(np.array(matrix(*values), dtype=complex))
        assert function(*values) == pytest.approx(eigenvalues.real.max(), abs=1e-12)
        roots = sp.Poly(
            derivation.characteristic.subs(dict(zip(arguments, map(sp.Float, values), strict=True))),
            sp.Symbol("mu"),
        ).nroots(n=20)
        assert max(complex(r).real for r in roots) == pytest.approx(eigenvalues.real.max(), abs=1e-12)


@pytest.mark.parametrize("kind", ["sum", "difference"])
def test_autonomous_matrix_follows_from_2_25_by_a_rotation(kind):
    # With x = R z, R = diag exp(−i r t), ẋ = M x becomes ż = N z, N = R⁻¹ M R + i r: M = R (N − i r) R⁻¹.
    derivation = hsu.derive(kind)
    values = values_of([*derivation.complex_matrix], 11)
    detuning, time = 0.37, 1.9
    values |= {hsu.DETUNING: detuning}
    constant = np.array(derivation.autonomous_matrix.subs(values), dtype=complex)
    moving = np.array(derivation.complex_matrix.subs(values | {hsu.TIME: time}), dtype=complex)
    # The rates of rotation are what the diagonal has lost.
    rates = 1j * (np.diag(constant) - np.diag(moving)).imag
    rotation = np.diag(np.exp(-rates * time))
    np.testing.assert_allclose(
        rotation @ (constant - np.diag(rates)) @ np.linalg.inv(rotation), moving, atol=1e-14
    )


damping = st.floats(1e-3, 1.0)
product = st.floats(-4.0, 4.0)


@CHECK
@given(f_k=damping, f_j=damping, real=product, imag=product)
def test_growth_rate_vanishes_at_the_borders_and_is_positive_between(f_k, f_j, real, imag):
    def growth(detuning):
        discriminant = (f_k - f_j) ** 2 - 4 * detuning**2 + real + 1j * (4 * detuning * (f_j - f_k) + imag)
        return (np.sqrt(discriminant).real - f_k - f_j) / 4

    lower, upper = criterion.border_function()(f_k, f_j, real, imag)
    if np.isnan(lower):
        assert np.isnan(upper)
        assert max(growth(detuning) for detuning in np.linspace(-10, 10, 2001)) < 1e-12
        return
    assert lower <= upper
    scale = 1 + abs(lower) + abs(upper)
    assert growth(lower) == pytest.approx(0, abs=1e-9 * scale)
    assert growth(upper) == pytest.approx(0, abs=1e-9 * scale)
    if upper - lower > 1e-3:
        assert growth((lower + upper) / 2) > 0
        assert growth(lower - 0.1 * scale) < 0
        assert growth(upper + 0.1 * scale) < 0


def test_border_of_equal_damping_is_the_textbook_one():
    # Mathieu with damping: |Λ| = ½√(P − 4f²); P = (δ amplitude / ω)².
    lower, upper = criterion.border_function()(0.1, 0.1, 0.25, 0.0)
    assert upper == pytest.approx(np.sqrt(0.25 - 4 * 0.1**2) / 2, rel=1e-14)
    assert lower == pytest.approx(-upper, rel=1e-14)


def test_pair_discriminant_is_the_one_derived():
    xi, eta = hsu.pair_discriminant()
    for kind in ("sum", "difference"):
        derivation = hsu.derive(kind)
        free = {s: 0 for s in derivation.xi.free_symbols if s.name[0] in "deg" or s.name in ("f_kj", "f_jk")}
        products = {hsu.PRODUCT_REAL: 0, hsu.PRODUCT_IMAG: 0}
        assert close(xi.subs(products), derivation.xi.subs(free))
        assert close(eta.subs(products), derivation.eta.subs(free))
        product = sp.expand(16 * derivation.block[0, 1] * derivation.block[1, 0])
        real, imag = product.as_real_imag()
        assert close(xi.subs(hsu.PRODUCT_REAL, real), derivation.xi)
        assert close(eta.subs(hsu.PRODUCT_IMAG, imag), derivation.eta)


@pytest.mark.parametrize("kind", KINDS)
def test_steps_name_every_equation_in_order(kind):
    numbers = [number for number, _, _ in hsu.derive(kind).steps()]
    assert numbers[0] == "2-16"
    last = "2-28" if kind == "difference" else "2-27"
    assert [n for i, n in enumerate(numbers) if n not in numbers[:i]] == [
        "2-16",
        "2-20",
        "2-22",
        "2-23",
        "2-25",
        "2-26",
        last,
    ]
    assert all(isinstance(item, sp.Basic) or item.is_Matrix for _, _, item in hsu.derive(kind).steps())


def test_derivation_is_done_once():
    assert hsu.derive("sum") is hsu.derive("sum")
    assert criterion.growth_rate_function("sum") is criterion.growth_rate_function("sum")


def test_unknown_kind_is_refused():
    with pytest.raises(ValueError, match="kind = 'product'"):
        hsu.derive("product")
