"""The nominal Xt28 on MuJoCo: a second engine to hold the bench's own engines against.

Built from the same machine file, driven by the same manoeuvres, on the same triangles. The laws
are written anew here from their description, so that a slip in ours would show.
"""
