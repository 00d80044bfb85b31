:- module(typhon_ros_messages,
          [ value_json/2,               % +Message, -JSON
            json_value/3,               % +Form, +JSON, -Message
            ros_name/3,                 % +Kind, +Name, -Atom
            ros_word/2,                 % +Kind, +Name
            ros_type/3,                 % +Kind, +Type, -Atom
            ros_id/1                    % -Id
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [ domain_error/2, instantiation_error/1, must_be/2,
                type_error/2 ]).
:- use_module(library(uuid), [uuid/1]).

/** <module> Messages as terms, and the names that come with them

A message is a dict, or a list of its fields, Name=Value, Name-Value or
Name(Value); values are numbers, `true` and `false`, text, lists of values,
and messages.  What ROS sends is a dict with text as strings, or, as
asked for, a list of Name=Value in the order of the names.

Names are checked before anything is sent: a server may not report what is
wrong with them.

*Threading*: any thread; no state.
*/

%!  value_json(+Message, -JSON) is det.
%
%   JSON is what json_write_dict/3 takes.
%
%   @error type_error(ros_message, Message), type_error(ros_value, Value)
%   @error duplicate_key(Field)

value_json(Message, JSON) :-
    must_be(nonvar, Message),
    (   message(Message, JSON0)
    ->  JSON = JSON0
    ;   type_error(ros_message, Message)
    ).

message(Dict, JSON) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs0),
    maplist(field, Pairs0, Pairs),
    dict_pairs(JSON, _, Pairs).
message(json(Fields), JSON) :-
    !,
    message(Fields, JSON).
message(Fields, JSON) :-
    is_list(Fields),
    maplist(field, Fields, Pairs),
    dict_pairs(JSON, _, Pairs).

field(Field, Name-Value) :-
    must_be(nonvar, Field),
    name_value(Field, Name, Value0),
    atom(Name),
    value(Value0, Value).

name_value(Name=Value, Name, Value) :- !.
name_value(Name-Value, Name, Value) :- !.
name_value(Field, Name, Value) :-
    compound(Field),
    compound_name_arguments(Field, Name, [Value]).

value(Value, _) :-
    var(Value),
    !,
    instantiation_error(Value).
value(Number, Number) :-
    integer(Number),
    !.
value(Number, Number) :-
    float(Number),
    !,
    finite(Number).
value(Text, Text) :-
    ( string(Text) ; Text == true ; Text == false ),
    !.
value([], []) :-
    !.
value(Atom, String) :-
    atom(Atom),
    !,
    atom_string(Atom, String).
value(Message, JSON) :-
    message(Message, JSON),
    !.
value(List, Values) :-
    is_list(List),
    !,
    maplist(value, List, Values).
value(Value, _) :-
    type_error(ros_value, Value).

%   JSON has no other numbers.

finite(Number) :-
    (   float_class(Number, Class),
        memberchk(Class, [infinite, nan])
    ->  type_error(ros_value, Number)
    ;   true
    ).

%!  json_value(+Form, +JSON, -Message) is det.
%
%   JSON is as of json_read_dict/2, Form is `dict` or `terms`.

json_value(dict, JSON, JSON).
json_value(terms, JSON, Message) :-
    terms(JSON, Message).

terms(Dict, Fields) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs),         % in the order of their names
    maplist(term_field, Pairs, Fields).
terms(List, Terms) :-
    is_list(List),
    !,
    maplist(terms, List, Terms).
terms(Value, Value).

term_field(Name-JSON, Name=Value) :-
    terms(JSON, Value).

                /*******************************
                *            NAMES             *
                *******************************/

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
