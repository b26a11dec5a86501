"""Writes release.csv (an elastic spring) and loop.csv (the same backbone with Masing's loop): python3 records.py"""
import math
import random

MASS, STIFFNESS, BEND, RATE, FINE = 1.0806, 500.0, 0.01, 100.0, 40  # kg, N/m, x_r in m, Hz


def backbone(x):
    return STIFFNESS * x / (1 + abs(x) / BEND)


def write(name, start, seconds, damping_ratio, masing):
    c = 2 * damping_ratio * math.sqrt(STIFFNESS * MASS)
    h = 1 / (RATE * FINE)
    x, v, turn, turn_force = start, 0.0, start, backbone(start)

    def force(x):
        return turn_force + 2 * backbone((x - turn) / 2) if masing else backbone(x)

    def rate(x, v):
        return v, -(force(x) + c * v) / MASS

    rows = []
    for _ in range(int(seconds * RATE)):
        rows.append(x)
        for _ in range(FINE):
            a = rate(x, v)
            b = rate(x + h / 2 * a[0], v + h / 2 * a[1])
            d = rate(x + h / 2 * b[0], v + h / 2 * b[1])
            e = rate(x + h * d[0], v + h * d[1])
            next_x = x + h / 6 * (a[0] + 2 * b[0] + 2 * d[0] + e[0])
            next_v = v + h / 6 * (a[1] + 2 * b[1] + 2 * d[1] + e[1])
            if masing and v * next_v < 0:  # a reversal: the next branch begins here
                at = x + v / (v - next_v) * (next_x - x)
                turn_force, turn = force(at), at
            x, v = next_x, next_v
    noise = random.Random(1)
    with open(name, "w") as file:
        file.write("t [s],x [mm]\n")
        for k, x in enumerate(rows):
            file.write(f"{k / RATE:.2f},{1000 * (x + 0.01 * start * noise.gauss(0, 1)):.4f}\n")


write("release.csv", 0.04, 20, 0.01, False)
write("loop.csv", 0.01, 8, 0.005, True)
