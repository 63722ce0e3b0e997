"""Makes the font of the formulas, STIXTwoMath-subset.woff2, from the whole of STIX Two Math.

    python3 subset.py STIX-TWO-MATH.woff2

README.md says where the whole font comes from, and which versions of the tools give these bytes.
"""

import pathlib
import sys

from fontTools import subset

# What pc-print writes: names in Latin and Greek letters, numbers, operators, brackets, roots, accents.
CHARACTERS = [
    (0x20, 0x7E),  # ASCII
    (0xA0, 0xFF),  # Latin letters of names, ± · × °
    (0x2C6, 0x2C7), (0x2D8, 0x2DD),  # accents above: hat, dot, ring, tilde
    (0x302, 0x304), (0x307, 0x308), (0x20D7, 0x20D7),
    (0x391, 0x3A9), (0x3B1, 0x3C9), (0x3D1, 0x3D1), (0x3D5, 0x3D6), (0x3F0, 0x3F1), (0x3F5, 0x3F5),  # Greek
    (0x2002, 0x200B), (0x2010, 0x2016), (0x2020, 0x2022), (0x2026, 0x2026),  # spaces, dashes, dots
    (0x2032, 0x2034), (0x2057, 0x2057),  # primes
    (0x2061, 0x2064),  # function application and what else is invisible
    (0x2070, 0x2070), (0x2074, 0x208E), (0xB2, 0xB3), (0xB9, 0xB9),  # digits above and below
    (0x210E, 0x210F), (0x2113, 0x2113), (0x211D, 0x211D),
    (0x2190, 0x2194), (0x21A6, 0x21A6), (0x21D2, 0x21D2), (0x21D4, 0x21D4),  # arrows
    (0x2200, 0x2200), (0x2202, 0x2209), (0x220F, 0x2213), (0x2215, 0x221E),
    (0x2223, 0x2223), (0x2225, 0x222E), (0x223C, 0x223C), (0x2243, 0x2248), (0x2260, 0x2265),
    (0x226A, 0x226B), (0x2282, 0x2287), (0x2295, 0x2297), (0x22A5, 0x22A5), (0x22C5, 0x22C6), (0x22EE, 0x22F1),
    (0x2308, 0x230B), (0x27E8, 0x27EB),  # brackets
    (0x1D400, 0x1D433),  # bold letters
    (0x1D434, 0x1D467),  # italic letters, which a browser puts for a single letter
    (0x1D6E2, 0x1D71B),  # italic Greek
]


def main(whole: str) -> None:
    options = subset.Options()
    options.flavor = "woff2"
    options.hinting = False
    # Forms of letters in indices, and dotless letters under accents; the MATH table is kept with the
    # variants and pieces of brackets and roots.
    options.layout_features = ["ssty", "dtls", "flac"]
    options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]  # with the notice and the licence
    options.recalc_timestamp = False
    options.with_zopfli = False
    font = subset.load_font(whole, options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=[c for low, high in CHARACTERS for c in range(low, high + 1)])
    subsetter.subset(font)
    subset.save_font(font, pathlib.Path(__file__).with_name("STIXTwoMath-subset.woff2"), options)


main(sys.argv[1])
