:- module(typhon_ros_parameters,
          [ ros_parameters/2,           % +Node, -Names
            ros_parameter/3,            % +Node, +Name, -Value
            ros_set_parameter/3         % +Node, +Name, +Value
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [existence_error/2, must_be/2, type_error/2]).
:- use_module('../common', [subscriber/2]).
:- use_module(calls, [call_json/5]).
:- use_module(names, [ros_name/3]).

/** <module> Parameters of nodes

These are services of each node of ROS 2, so they are the same whatever the
way to ROS.

*Threading*: the thread that runs the agent, which waits for answers.
*/

%!  ros_parameters(+Node, -Names:list(atom)) is det.
%!  ros_parameter(+Node, +Name, -Value) is det.
%!  ros_set_parameter(+Node, +Name, +Value) is det.
%
%   The parameters of Node, the value of one, and give it another.  A value
%   is `true` or `false`, a number, a string, or a list of them.  An integer
%   is not taken for a parameter that is a float.
%
%   @error existence_error(ros_service, Service) if there is no such Node
%   @error existence_error(ros_parameter, Name)
%   @error ros_error(refused, Name)
%   @error type_error(ros_parameter, Value), and those of ros_call/4

ros_parameters(Node, Names) :-
    ask(Node, list_parameters, 'ListParameters', _{prefixes:[], depth:0},
        JSON),
    maplist(atom_string, Names, JSON.result.names).

ros_parameter(Node, Name, Value) :-
    must_be(atom, Name),
    ask(Node, get_parameters, 'GetParameters', _{names:[Name]}, JSON),
    (   JSON.values = [Said|_],
        said_value(Said.type, Key)
    ->  Value = Said.get(Key)
    ;   existence_error(ros_parameter, Name)
    ).

ros_set_parameter(Node, Name, Value) :-
    must_be(atom, Name),
    must_be(ground, Value),
    (   value_type(Value, Type)
    ->  said_value(Type, Key),
        dict_pairs(Said, _, [type-Type,Key-Value])
    ;   type_error(ros_parameter, Value)
    ),
    ask(Node, set_parameters, 'SetParameters',
        _{parameters:[_{name:Name, value:Said}]}, JSON),
    JSON.results = [Result|_],
    (   Result.successful == true
    ->  true
    ;   throw(error(ros_error(refused, Name), context(_, Result.reason)))
    ).

ask(Node0, Name, Type, Request, JSON) :-
    subscriber(Host, _),
    ros_name(node, Node0, Node),
    atomic_list_concat([Node, Name], /, Service),
    atom_concat('rcl_interfaces/srv/', Type, FullType),
    call_json(Host, Service, FullType, Request, JSON).

%   As rcl_interfaces/msg/ParameterType counts; 0 is none.

said_value(1, bool_value).
said_value(2, integer_value).
said_value(3, double_value).
said_value(4, string_value).
said_value(5, byte_array_value).
said_value(6, bool_array_value).
said_value(7, integer_array_value).
said_value(8, double_array_value).
said_value(9, string_array_value).

value_type(List, Type) :-
    is_list(List),
    !,
    List = [First|_],
    value_type(First, Type1),
    maplist(of_type(Type1), List),
    Type is Type1+5.
value_type(true, 1) :- !.
value_type(false, 1) :- !.
value_type(Value, 2) :- integer(Value).
value_type(Value, 3) :- float(Value).
value_type(Value, 4) :- ( string(Value) ; atom(Value) ).

of_type(Type, Value) :-
    value_type(Value, Type),
    !.
