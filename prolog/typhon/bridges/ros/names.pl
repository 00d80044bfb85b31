:- module(typhon_ros_names,
          [ ros_name/3,                 % +Kind, +Name, -Atom
            ros_word/2,                 % +Kind, +Name
            ros_type/3,                 % +Kind, +Type, -Atom
            ros_id/1                    % -Id
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(uuid), [uuid/1]).

/** <module> Names of topics, services, actions, nodes and types

Checked before anything is sent: what is wrong with them is known here, and
a server may say nothing.

*Threading*: any thread; no state.
*/

%!  ros_name(+Kind, +Name, -Atom) is det.
%
%   Name is text as `/robot/cmd_vel`, `cmd_vel` or `~/cmd_vel`: words of
%   letters, digits and `_`, none of which begins with a digit.
%
%   @error domain_error(ros_name(Kind), Name), Kind being topic, service,
%          action or node

ros_name(Kind, Name, Atom) :-
    text(Name, Atom),
    atom_codes(Atom, Codes),
    length(Codes, Length),
    (   Length =< 255,
        phrase(name, Codes)
    ->  true
    ;   domain_error(ros_name(Kind), Name)
    ).

%!  ros_word(+Kind, +Name:atom) is det.
%
%   Name is one word of such a name.
%
%   @error domain_error(ros_name(Kind), Name)

ros_word(Kind, Name) :-
    (   word(Name)
    ->  true
    ;   domain_error(ros_name(Kind), Name)
    ).

name --> "~/", !, words.
name --> "/", !, words.
name --> words.

words --> word, more.

more --> "/", !, words.
more --> [].

word --> [C], { code_type(C, csymf), C < 128 }, rest.

rest --> [C], { code_type(C, csym), C < 128 }, !, rest.
rest --> [].

%!  ros_type(+Kind, +Type, -Atom) is det.
%
%   Type is text as `std_msgs/msg/String`, or as ROS 1 writes it,
%   `std_msgs/String`; Kind is msg, srv or action.
%
%   @error domain_error(ros_type(Kind), Type)

ros_type(Kind, Type, Atom) :-
    text(Type, Atom),
    atomic_list_concat(Parts, /, Atom),
    (   ( Parts = [Package,Name] ; Parts = [Package,Kind,Name] ),
        word(Package),
        word(Name)
    ->  true
    ;   domain_error(ros_type(Kind), Type)
    ).

word(Atom) :-
    atom_codes(Atom, Codes),
    phrase(word, Codes).

text(Text, Atom) :-
    must_be(nonvar, Text),
    (   ( atom(Text) ; string(Text) )
    ->  atom_string(Atom, Text)
    ;   must_be(atom, Text)
    ).

%!  ros_id(-Id:atom) is det.
%
%   An id that no other client of a server has: some servers keep those of
%   all clients in one table.

ros_id(Id) :-
    uuid(Uuid),
    atom_concat('typhon:', Uuid, Id).
