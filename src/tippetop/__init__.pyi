"""The public names, and where they live: the package loads them from here."""

from . import presets as presets
from .bodies import Body as Body
from .bodies import EccentricSphere as EccentricSphere
from .bodies import Ring as Ring
from .bodies import Shape as Shape
from .bodies import Sphere as Sphere
from .bodies import Spheroid as Spheroid
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
from .export.solid import write_solid as write_solid
from .figures.overview import plot as plot
from .frictions import ContensouFriction as ContensouFriction
from .frictions import CoulombFriction as CoulombFriction
from .frictions import Friction as Friction
from .frictions import RegularizedCoulombFriction as RegularizedCoulombFriction
from .frictions import ViscousFriction as ViscousFriction
from .lab.notebook import view as view
from .lathe.workpiece import Insert as Insert
from .lathe.workpiece import Workpiece as Workpiece
from .mechanics.hertz import MATERIALS as MATERIALS
from .mechanics.hertz import Material as Material
from .mechanics.hertz import hertz_patch_radius as hertz_patch_radius
from .netcdf import read_run as read_run
from .netcdf import write_run as write_run
from .problem import Contact as Contact
from .problem import Launch as Launch
from .problem import Problem as Problem
from .run import simulate as simulate
from .summary import summarize as summarize
from .sweeps.run import sweep as sweep
from .theory.drilling import standing_time as standing_time
from .theory.overview import steady_states as steady_states
from .theory.prediction import predict as predict
from .theory.stem import least_jellett_to_stand as least_jellett_to_stand
from .theory.thresholds import critical_spins as critical_spins

__version__: str
