"""Makes the demo place; see tools/make_demo_place.py."""
