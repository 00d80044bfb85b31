:- module(typhon_ros_words,
          [ ros_words/1                 % -PIs
          ]).
:- use_module(library(lists), [member/2]).

/** <module> What agents find on a host with ROS

*Threading*: no state.
*/

:- reexport(topics).
:- reexport(calls, except([call_json/5])).
:- reexport(actions).
:- reexport(parameters).

%!  ros_words(-PIs:list) is det.

ros_words(PIs) :-
    findall(PI,
            ( member(Part, [typhon_ros_topics, typhon_ros_calls,
                            typhon_ros_actions, typhon_ros_parameters]),
              module_property(Part, exports(Exports)),
              member(PI, Exports),
              PI \== call_json/5 ),
            PIs).
