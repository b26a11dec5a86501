"""Writes the records of the guides, whose truth is known. A seed each: the same bytes on every machine."""
import csv, math, random


def decay(t, modes):
    """Free decay of modes (frequency [Hz], damping ratio, amplitude) from t = 0 on."""
    if t < 0:
        return 0.0
    return sum(a * math.exp(-xi * 2 * math.pi * f * t) * math.cos(2 * math.pi * f * math.sqrt(1 - xi**2) * t) for f, xi, a in modes)


def write(name, header, rows):
    with open(name, "w", newline="") as stream:
        out = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
        out.writerow(header)
        out.writerows(rows)


# phone.csv: as a phone's app exports it. Three axes, about 100 Hz, noise of 0.02 m/s2, released after 2 s.
random.seed(11)
rows, t = [], 0.0
for i in range(2000):
    t += 0.01 + random.gauss(0, 2e-5)
    z = decay(t - 2.0, [(6.2, 0.008, 3.0), (38.9, 0.005, 0.6)])
    rows.append([round(t, 7), round(0.04 * z + random.gauss(0, 0.02), 6), round(random.gauss(0, 0.02), 6), round(z + random.gauss(0, 0.02), 6)])
write("phone.csv", ["Time (s)"] + [f"Linear Acceleration {axis} (m/s^2)" for axis in "xyz"], rows)

# close_modes.csv: two sensors, two modes 2 % apart, 20 s at 100 Hz, noise of 0.01 m/s2.
random.seed(15)
first, second = (5.0, 0.00318, 1.0), (5.1, 0.00318, 1.0)
rows = []
for i in range(2000):
    a, b = decay(i / 100, [first]), decay(i / 100, [second])
    rows.append([i / 100, round(a + b + random.gauss(0, 0.01), 6), round(a - 0.7 * b + random.gauss(0, 0.01), 6)])
write("close_modes.csv", ["time_s", "acceleration_left_m_per_s2", "acceleration_right_m_per_s2"], rows)
