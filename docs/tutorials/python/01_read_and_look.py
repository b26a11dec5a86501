# %% [markdown]
# # 1. Read a record and look at it
# Cells of this file run in Jupyter, VS Code and Spyder, or all at once: `./bootstrap python docs/tutorials/python/01_read_and_look.py`.
# Lines that begin with #> are what a cell prints. The record was simulated: a steel cantilever, released; 3.4555 Hz, 0.45 %.

# %%
import beamid
import matplotlib.pyplot as plt
import numpy as np

folder = "docs/tutorials/02_identify_a_record/"
record = beamid.read(folder + "tip_acceleration.csv")
print(record.samples.shape, record.channels[0]["quantity"], record.channels[0]["unit"])
#> (2501, 1) acceleration m/s2

# %% [markdown]
# Its header tells quantities and units. Where a file has no such header, `read` takes the words of [record] of an experiment file.

# %%
bare = np.loadtxt(folder + "tip_acceleration.csv", delimiter=",", skiprows=1)
same = beamid.Record(bare[:, 0], acceleration_m_per_s2=bare[:, 1], name="bare")
print(same)
#> Record 'bare': 2501 samples of acceleration [m/s2]

# %% [markdown]
# What is in it, and what is wrong with it?

# %%
seen = beamid.inspect(record)
print(*seen.report.splitlines()[3:5], sep="\n")
print(seen.messages)
#> Read as delimited_text. 2501 samples from 0 to 10 s (10 s). Time is column 1, 'time_s'. Evenly
#> sampled at 250 Hz.
#> []

# %% [markdown]
# Its modes, without any model. A table is a dictionary of numpy arrays.

# %%
found = beamid.modal(record, window=(2, 10))
modes = found.tables["modes"]
print(modes["frequency_hz"], modes["damping_ratio_percent"])
#> [3.455522] [0.4492]

# %% [markdown]
# Curves of the report's figures are arrays too.

# %%
figure, axes = plt.subplots()
axes.plot(record.time, record.samples[:, 0], linewidth=0.7)
axes.set(xlabel="time [s]", ylabel="acceleration of the tip [m/s²]")
figure.savefig("record.png")
print(list(found.figures))
#> ['stabilisation', 'reproduction', 'singular_values']
