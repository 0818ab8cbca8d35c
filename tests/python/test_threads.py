"""The interpreter goes on while the library works, and Ctrl-C ends the work."""

import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest

import reradiant as rr
from scenes import EXAMPLES


class Threads(unittest.TestCase):
    def test_other_threads_run_during_a_render(self):
        ticks = []
        stop = threading.Event()

        def tick():
            while not stop.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        begin = time.monotonic()
        rr.render(EXAMPLES / "fluorescent-smooth.toml", time=1.0)
        end = time.monotonic()
        stop.set()
        thread.join()
        during = [at for at in ticks if begin < at < end]
        # A held lock would leave none; a busy machine still grants a few of the hundred.
        self.assertGreater(len(during), 10)

    def test_renders_in_two_threads_agree_with_those_in_turn(self):
        scene = EXAMPLES / "fluorescent-bare.toml"
        alone = [rr.render(scene, spp=1, seed=seed, bands=(400, 700, 100)) for seed in (1, 2)]
        together = {}

        def work(seed):
            together[seed] = rr.render(scene, spp=1, seed=seed, bands=(400, 700, 100))

        threads = [threading.Thread(target=work, args=(seed,)) for seed in (1, 2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed in (1, 2):
            self.assertTrue((together[seed].values == alone[seed - 1].values).all())


class Interrupts(unittest.TestCase):
    def interrupted(self, call, patience):
        """Sends SIGINT a second after the call began; the process must say so and go on."""
        program = textwrap.dedent(f"""
            import signal, reradiant as rr
            signal.signal(signal.SIGINT, signal.default_int_handler)
            print("begins", flush=True)
            try:
                {call}
                print("ended by itself")
            except KeyboardInterrupt:
                print("interrupted", rr.presets()[0] != "")
        """)
        child = subprocess.Popen([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE,
                                 text=True)
        with child:
            self.assertEqual(child.stdout.readline().strip(), "begins")
            time.sleep(1)
            child.send_signal(signal.SIGINT)
            begin = time.monotonic()
            said = child.communicate(timeout=120)[0].strip()
        self.assertEqual((said, child.returncode), ("interrupted True", 0))
        self.assertLess(time.monotonic() - begin, patience)

    def test_render(self):
        # A pass ends before the call does; kernels may still be being built when the signal comes.
        self.interrupted(f"rr.render({str(EXAMPLES / 'fluorescent-bare.toml')!r}, time=1000)", 60)

    def test_walk(self):
        self.interrupted("rr.measure(preset='brass', model='walk', samples=10**9)", 20)

    def test_fit(self):
        # Steps of a dense matrix take long; the process is quick to notice between them.
        recipe = str(EXAMPLES / "synth-orange.toml")
        self.interrupted(f"while True: rr.fit(rr.synth({recipe!r}, seed=1).data, rank=2)", 20)


if __name__ == "__main__":
    unittest.main()
