"""M, c and g of a URDF by Lagrange's equations in SymPy, independent of mozzi, compared with mozzi's modules.

Usage: lagrange.py robot.urdf mass_matrix.py velocity_product.py gravity_forces.py
"""

import sys
import xml.etree.ElementTree as xml

import sympy as sp

urdf, *modules = sys.argv[1:]
found = {}
for path in modules:
    scope = {}
    exec(open(path).read(), scope)
    found.update({k: v for k, v in scope.items() if k in ("mass_matrix", "velocity_product", "gravity_forces")})
    found.setdefault("values", {}).update(scope["values"])
symbol_of = {value: symbol for symbol, value in found["values"].items()}
assert len(symbol_of) == len(found["values"]), "the numbers of the file are different"


def number(text):
    """The symbol with this number in the file, else the number."""
    value = sp.Rational(text)
    return sp.sign(value) * symbol_of.get(abs(value), abs(value))


def vector(text):
    return sp.Matrix([number(x) for x in text.split()])


def angle(text):
    x = float(text)
    return sp.nsimplify(round(x / 3.14159265358979 * 2)) * sp.pi / 2 if abs(x) > 1e-3 else sp.Integer(0)


def rotation(axis, q):
    x, y, z = axis
    W = sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return sp.eye(3) + sp.sin(q) * W + (1 - sp.cos(q)) * W * W


root = xml.parse(urdf).getroot()
links = {link.get("name"): link for link in root.findall("link")}
joints = root.findall("joint")
n = len(joints)
theta = sp.symbols(f"theta1:{n + 1}", real=True)
dtheta = sp.symbols(f"dtheta1:{n + 1}", real=True)
R, p = sp.eye(3), sp.zeros(3, 1)
kinetic, potential = sp.zeros(n, n), sp.Integer(0)
omega = sp.zeros(3, n)  # Jacobian of the angular velocity, in link axes
for i, joint in enumerate(joints):
    origin = joint.find("origin")
    p = p + R * vector(origin.get("xyz"))
    roll, pitch, yaw = (angle(x) for x in origin.get("rpy").split())
    step = rotation((0, 0, 1), yaw) * rotation((0, 1, 0), pitch) * rotation((1, 0, 0), roll)
    axis = sp.Matrix([sp.Rational(x) for x in joint.find("axis").get("xyz").split()])
    if joint.get("type") == "prismatic":
        R = R * step
        p = p + R * axis * theta[i]
        omega = step.T * omega
    else:
        turn = rotation(axis, theta[i])
        R = R * step * turn
        omega = (step * turn).T * omega
        omega[:, i] += axis
    inertial = links[joint.find("child").get("link")].find("inertial")
    mass = number(inertial.find("mass").get("value"))
    entries = inertial.find("inertia")
    I = sp.diag(*(number(entries.get(k)) for k in ("ixx", "iyy", "izz")))
    center = p + R * vector(inertial.find("origin").get("xyz"))
    velocity = center.jacobian(sp.Matrix(theta))
    kinetic += mass * velocity.T * velocity + omega.T * I * omega
    potential += mass * number("9.81") * center[2]
christoffel = lambda i, j, k: (
    sp.diff(kinetic[i, j], theta[k]) + sp.diff(kinetic[i, k], theta[j]) - sp.diff(kinetic[j, k], theta[i])
) / 2
c = [sum(christoffel(i, j, k) * dtheta[j] * dtheta[k] for j in range(n) for k in range(n)) for i in range(n)]
g = [sp.diff(potential, theta[i]) for i in range(n)]

sines = {sp.sin(q): sp.Symbol(f"s{i}") for i, q in enumerate(theta)}
cosines = {sp.cos(q): sp.Symbol(f"c{i}") for i, q in enumerate(theta)}
pythagoras = [sines[sp.sin(q)] ** 2 + cosines[sp.cos(q)] ** 2 - 1 for q in theta]


def is_zero(x):
    """Exactly: as a polynomial in sines and cosines, reduced by Pythagoras."""
    x = sp.expand(sp.expand_trig(sp.expand(x))).subs(sines).subs(cosines)
    if x == 0:
        return True
    return sp.reduced(sp.expand(x), pythagoras, *sines.values(), *cosines.values())[1] == 0


for i in range(n):
    for j in range(n):
        assert is_zero(kinetic[i, j] - found["mass_matrix"][i, j]), f"M{i + 1}{j + 1}"
    assert is_zero(c[i] - found["velocity_product"][i]), f"c{i + 1}"
    assert is_zero(g[i] - found["gravity_forces"][i]), f"g{i + 1}"
if n == 2:
    differences = list(kinetic - found["mass_matrix"]) + [c[i] - found["velocity_product"][i] for i in range(n)]
    assert all(sp.simplify(x) == 0 for x in differences), "by simplify"
print("equal")
