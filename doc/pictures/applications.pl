:- module(doc_pictures_applications,
          [ application_pictures/1      % +Directory
          ]).
:- use_module('../../examples/applications/fire/scene', []).
:- use_module('../../examples/applications/irrigation/scene', []).
:- use_module('../../examples/applications/solar/scene', []).
:- use_module('../../examples/applications/warehouse/scene', []).
:- use_module('../../prolog/typhon',
              [network_advance/2, network_start/3, network_stop/1]).
:- use_module(library(filesex), [directory_file_path/3]).

/** <module> The worlds of the applications, as their pages show them

*Threading*: the main thread.
*/

%!  application_pictures(+Directory) is det.
%
%   Write application-NAME.svg for each application.

application_pictures(Directory) :-
    forall(shown(Name, Scene, Options, Seconds),
           picture(Directory, Name, Scene, Options, Seconds)).

shown(fire, fire_scene, [fire(20)], 130).
shown(irrigation, irrigation_scene, [], 1 123 200).      % 13 days
shown(solar, solar_scene, [], 149 400).      % 17:30 of the second day
shown(warehouse, warehouse_scene, [delta(2)], 90).

picture(Directory, Name, Scene, Options, Seconds) :-
    Scene:scene_network(Options, Topology, More),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log('/dev/null')|More]),
        ( Scene:scene_start(Network, Options),
          network_advance(Network, Seconds),
          Scene:scene_picture(Svg) ),
        ( Scene:scene_stop,
          network_stop(Network) )),
    atomic_list_concat(['application-', Name, '.svg'], Base),
    directory_file_path(Directory, Base, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        format(Out, '~s~n', [Svg]),
        close(Out)),
    format('~w~n', [File]).
