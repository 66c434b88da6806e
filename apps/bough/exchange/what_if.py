"""What would a gust do to a rotor that runs up? A notebook in cells: python3 apps/bough/exchange/what_if.py

Where Python does not find bough, name its places:
PYTHONPATH=apps/bough/exchange BOUGH_LIBRARY=build/release/libbough.so python3 apps/bough/exchange/what_if.py
"""
# %% The run-up of the turbine, its first seconds
import os

import bough

scene = os.path.join(os.path.dirname(__file__), "..", "..", "turbine", "runup.yaml")
shown = ["RotSpeed", "OoPDefl1"]  # speed, and the first blade's tip downwind

run = bough.Session(scene, "simulation.threads=1")
start = run.advance(4.0, shown)
print("channels:", len(run.names))
print("after %g s: %.2f rpm, tip %.2f m" % (run.time, run["RotSpeed"], run["OoPDefl1"]))

# %% A copy of this moment, and how it goes on
moment = run.save()
steady = run.advance(6.0, shown)

# %% From the same moment: the same scene in another wind
gust = bough.Session(scene, "simulation.threads=1", "aero.wind.speed=25 m/s")
gust.restore(moment)
gusty = gust.advance(6.0, shown)

# %% Taken back, the first goes on as it did, to the last bit
run.restore(moment)
again = run.advance(6.0, shown)
print("repeated to the bit:", all(bytes(again[c]) == bytes(steady[c]) for c in again))
print("largest tip deflection in 20 m/s: %.2f m, in 25 m/s: %.2f m"
      % (max(steady["OoPDefl1"]), max(gusty["OoPDefl1"])))

# %% A picture, where matplotlib is installed
try:
    import matplotlib.pyplot as plt
except ImportError:
    plt = None
if plt:
    figure, axes = plt.subplots(2, sharex=True)
    for axis, channel in zip(axes, shown):
        axis.plot(start["Time"], start[channel], color="0.5")
        axis.plot(steady["Time"], steady[channel], label="20 m/s")
        axis.plot(gusty["Time"], gusty[channel], label="25 m/s")
        axis.set_ylabel("%s [%s]" % (channel, run.units[run.names.index(channel)]))
    axes[0].legend()
    axes[1].set_xlabel("Time [s]")
    figure.savefig("what-if.svg")
    print("picture: what-if.svg")
