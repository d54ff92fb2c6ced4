"""The public names, and where they live: the package loads them from here."""

from . import presets as presets
from .catalogue import Ending as Ending
from .contact.mode import Outcome as Outcome
from .errors import FileTrouble as FileTrouble
from .errors import InvalidInput as InvalidInput
from .errors import TippetopError as TippetopError
from .errors import Unavailable as Unavailable
from .export.csv import write_csv as write_csv
from .export.glb import write_glb as write_glb
from .export.html import write_html as write_html
from .export.movie import write_movie as write_movie
from .figures.overview import plot as plot
from .lab.notebook import view as view
from .netcdf import read_run as read_run
from .netcdf import write_run as write_run
from .problem import Body as Body
from .problem import Contact as Contact
from .problem import EccentricSphere as EccentricSphere
from .problem import Friction as Friction
from .problem import Launch as Launch
from .problem import Problem as Problem
from .problem import RegularizedCoulombFriction as RegularizedCoulombFriction
from .problem import Shape as Shape
from .problem import Spheroid as Spheroid
from .problem import ViscousFriction as ViscousFriction
from .run import simulate as simulate
from .summary import summarize as summarize
from .sweeps.run import sweep as sweep
from .theory.overview import steady_states as steady_states
from .theory.prediction import predict as predict
from .theory.thresholds import critical_spins as critical_spins

__version__: str
