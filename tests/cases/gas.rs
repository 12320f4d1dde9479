//! Gas in scenes that once gave wrong numbers: mixtures, vents, small differences of pressure, many orifices.
