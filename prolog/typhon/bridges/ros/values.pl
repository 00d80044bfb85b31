:- module(typhon_ros_values,
          [ value_json/2,               % +Message, -JSON
            json_value/3                % +Form, +JSON, -Message
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [instantiation_error/1, must_be/2, type_error/2]).

/** <module> Messages as terms

A message is a dict, or a list of its fields, Name=Value, Name-Value or
Name(Value); values are numbers, `true` and `false`, text, lists of values,
and messages.  On the way in it is a dict with text as strings, or, as
asked for, a list of Name=Value in the order of the names.

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
