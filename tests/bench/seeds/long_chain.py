"""A chain of many storeys identified in parts: time, and deviations over those of the whole where that is affordable.

    python3 tests/bench/seeds/long_chain.py STOREYS PARTS [--whole] [--seconds 10] [--beamid build/release/bin/beamid]

Storeys of 1.6 MN/m under floors of 1000 kg, c = beta k, a measured random force on every tenth floor, an accelerometer on
every floor with 5 % of noise; neighbouring parts share one storey. --whole: all storeys by one filter too.
"""
import argparse, json, math, pathlib, resource, statistics, subprocess, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parents[3]


def numbers(value, count):
    return "[" + ",\n".join(", ".join([repr(value)] * min(50, count - i)) for i in range(0, count, 50)) + "]"


def chain(storeys, parts, seconds, noise, guess=1.2):
    k, beta = 1.6e6, 0.006 / (2 * math.pi * 0.8387)
    text = f"[chain]\nmasses_kg = {numbers(1000, storeys)}\nstiffnesses_n_per_m = {numbers(k, storeys)}\ndashpots_n_s_per_m = {numbers(beta * k, storeys)}\n"
    for floor in range(5, storeys + 1, 10):
        text += f'[[excitations]]\nkind = "random"\namplitude_n = 500\nfrequency_hz = 50\nposition_m = {floor}\n'
    text += f"[simulation]\nduration_s = {seconds}\nsampling_rate_hz = 100\nsteps_per_sample = 20\nmethod = \"newmark\"\n"
    text += "[filter]\ndiscretisation = \"pade\"\n"
    text += f"[noise]\nacceleration_m_per_s2 = {noise}\n[model]\nname = \"beam\"\nsensor_bias = false\n[reduction]\nmethod = \"none\"\n"
    for floor in range(1, storeys + 1):
        text += f"[[sensors]]\nposition_m = {floor}\nnoise_m_per_s2 = {noise}\n"
        for letter, quantity, unit, value, deviation in (("k", "storey_stiffness", "n_per_m", k, 0.5), ("c", "storey_damping", "n_s_per_m", beta * k, 1.0)):
            text += (f'[[parameters]]\nname = "{letter}{floor}"\nquantity = "{quantity}"\nfrom_m = {floor - 1}\nto_m = {floor}\n'
                     f'form = "logarithmic"\nguess_{unit} = {guess * value}\nrelative_deviation = {deviation}\n')
    length = storeys // parts
    for i in range(parts if parts > 1 else 0):
        text += f'[[substructures]]\nname = "part {i + 1}"\n'
        if i > 0:
            text += f"from_m = {i * length}\n"
        if i < parts - 1:
            text += f"to_m = {(i + 1) * length + 1}\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("storeys", type=int)
    parser.add_argument("parts", type=int)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--beamid", default=str(ROOT / "build/release/bin/beamid"))
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "chain.toml").write_text(chain(given.storeys, given.parts, given.seconds, given.noise))

        def run(*arguments):
            begin = time.monotonic()
            done = subprocess.run([given.beamid, *arguments], cwd=folder, capture_output=True, text=True)
            if done.returncode not in (0, 3):
                raise SystemExit(done.stderr)
            return done.stdout, time.monotonic() - begin

        _, seconds = run("simulate", "--config", "chain.toml", "--out", "shaken")
        print(f"simulated in {seconds:.1f} s", flush=True)
        if given.parts > 1:
            output, seconds = run("substructures", "shaken/record.csv", "--config", "chain.toml", "--no-whole", "--json")
            values = json.loads(output)
            good = sum(part["sections_noisy"]["status"] == "converged" for part in values["parts"])
            processor = resource.getrusage(resource.RUSAGE_CHILDREN)
            print(f"processor time so far {processor.ru_utime + processor.ru_stime:.0f} s")
            print(f"{given.storeys} storeys in {given.parts} parts: {seconds:.1f} s, {good} parts converged")
            for letter, truth in (("k", 1.6e6), ("c", 0.006 / (2 * math.pi * 0.8387) * 1.6e6)):
                joined = [one for one in values["joined"] if one["name"][0] == letter]
                off = [(one["value"] - truth) / one["deviation"] for one in joined]
                print(f"{letter}: deviation {100 * statistics.median(one['deviation'] for one in joined) / truth:.3f} % (median), "
                      f"worst error {100 * max(abs(one['value'] - truth) for one in joined) / truth:.2f} %, "
                      f"mean square over its deviation {statistics.fmean(x * x for x in off):.3f} of {len(off)}")
        if given.whole:
            _, seconds = run("identify", "shaken/record.csv", "--config", "chain.toml", "--json")
            processor = resource.getrusage(resource.RUSAGE_CHILDREN)
            print(f"processor time so far {processor.ru_utime + processor.ru_stime:.0f} s")
            print(f"{given.storeys} storeys by one filter: {seconds:.1f} s")


if __name__ == "__main__":
    main()
