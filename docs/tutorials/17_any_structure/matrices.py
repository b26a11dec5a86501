# M, K_0 and the part of each storey in K, as any finite-element program could write them
masses, stiffnesses = [1000.0, 1000.0, 800.0], [2.0e6, 1.5e6, 1.2e6]
n = len(masses)

def write(name, entries):
    with open(name, "w") as file:
        file.write("%%MatrixMarket matrix coordinate real symmetric\n")
        file.write(f"{n} {n} {len(entries)}\n")
        for (i, j), value in entries.items():
            file.write(f"{i + 1} {j + 1} {value!r}\n")

write("M.mtx", {(i, i): m for i, m in enumerate(masses)})
write("K0.mtx", {})
for i, k in enumerate(stiffnesses):
    write(f"K{i + 1}.mtx", {(i, i): k, **({(i, i - 1): -k, (i - 1, i - 1): k} if i else {})})
