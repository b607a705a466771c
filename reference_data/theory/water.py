"""Density and viscosity of air-free water at one atmosphere, 0 to 40 C."""


def density(celsius):
    """Kell (1975), J. Chem. Eng. Data 20, 97: kg/m3."""
    t = celsius
    numerator = 999.83952 + t * (16.945176 + t * (-7.9870401e-3 + t * (-46.170461e-6 + t * (105.56302e-9 - 280.54253e-12 * t))))
    return numerator / (1.0 + 16.879850e-3 * t)


def viscosity(celsius):
    """Kestin, Sokolov & Wakeham (1978), J. Phys. Chem. Ref. Data 7, 941: Pa s."""
    below = 20.0 - celsius
    return 1.002e-3 * 10.0 ** (below / (celsius + 96.0) * (1.2364 - 1.37e-3 * below + 5.7e-6 * below**2))
