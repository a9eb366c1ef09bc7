"""500 images a second from one exposure as a film: film.py RECORDING NUMBER FILM.gif"""
import sys

from PIL import Image

import fast_edi

RATE_HZ = 500
SHOW_MS = 100  # each image of the film

recording = fast_edi.open(sys.argv[1])
deblurrer = fast_edi.Deblurrer(recording.sensor_size, contrast_threshold_on=0.26,
                               contrast_threshold_off=0.24, latent_rate_hz=RATE_HZ)
result = list(deblurrer.run(recording))[int(sys.argv[2])]
start, end = result.exposure
images = [Image.fromarray(latent.image) for latent in result.latent if start <= latent.stamp < end]
images[0].save(sys.argv[3], save_all=True, append_images=images[1:], duration=SHOW_MS, loop=0)
print(f"{len(images)} images of an exposure of {(end - start) / 1000} ms")
