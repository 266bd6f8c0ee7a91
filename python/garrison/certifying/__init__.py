"""gr.certify: what measurements say of the state, whatever some of their sources say, without any filter."""

from garrison.certifying.certified import Certified
from garrison.certifying.run import certify

__all__ = ["Certified", "certify"]
