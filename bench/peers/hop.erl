%% Erlang's side of bench/peers.pl: two nodes, and what goes to and fro.
%%
%%   erl -noshell ... -run hop main There Ebin Bytes
%%
%% An agent is a fun of 30 clauses and a list of 10 facts. Its source goes
%% with it: the fun was made by erl_eval, so it travels as abstract forms,
%% and is evaluated wherever it is. A host makes a process for each agent
%% that comes. A known fun is one that both hosts were given before, as ours
%% have the program of an agent from its first visit on: only its hash goes
%% with the facts. The message is a binary of as many bytes as a hop of ours.
%% Nothing is answered, counted or kept for the case that it gets lost.
%%
%% Epmd is not needed: both nodes listen on one port, of two addresses.

-module(hop).
-export([main/1]).

main([There, Ebin, Bytes]) ->
    {ok, Peer, Node} = start(There, Ebin),
    register(host, spawn_link(fun() -> host(#{}) end)),
    erpc:call(Node, erlang, apply, [fun started/0, []]),
    message(Node, list_to_integer(Bytes)),
    agents(Node),
    peer:stop(Peer),
    halt().

start(There, Ebin) ->
    [Name, Address] = string:split(There, "@"),
    peer:start_link(#{name => Name, host => Address,
                      connection => standard_io,
                      args => ["+sbwt", "none", "-pa", Ebin, "-setcookie",
                               atom_to_list(erlang:get_cookie()),
                               "-start_epmd", "false",
                               "-erl_epmd_port", port(),
                               "-kernel", "inet_dist_use_interface",
                               interface(Address)]}).

port() ->
    {ok, [[Port]]} = init:get_argument(erl_epmd_port),
    Port.

interface(Address) ->
    {ok, Numbers} = inet:parse_address(Address),
    lists:flatten(io_lib:format("~w", [Numbers])).

started() ->
    register(host, spawn(fun() -> host(#{}) end)).

%% What throws back what comes, and takes agents in.

host(Known) ->
    receive
        {throw_back, From, Term} ->
            From ! {throw_back, self(), Term},
            host(Known);
        {arrive, Agent, Facts} when is_function(Agent) ->
            spawn(fun() -> Agent({arrived, Facts}) end),
            host(Known);
        {arrive, Hash, Facts} ->
            #{Hash := Agent} = Known,
            spawn(fun() -> Agent({arrived, Facts}) end),
            host(Known);
        {know, Hash, Agent} ->
            host(Known#{Hash => Agent})
    end.

%%                          ---- messages ----

message(Node, Bytes) ->
    Binary = binary:copy(<<"a">>, Bytes),
    size("Erlang, bare message", {throw_back, self(), Binary}),
    told("Erlang, bare message", Node, 5,
         fun(Many, Hops) -> messages(Node, Binary, Many, Hops) end).

messages(Node, Binary, Many, Hops) ->
    Each = Hops div 2 - Many,
    [{host, Node} ! {throw_back, self(), Binary} || _ <- lists:seq(1, Many)],
    throw_again(Each),
    [receive {throw_back, _, _} -> ok end || _ <- lists:seq(1, Many)].

throw_again(0) ->
    ok;
throw_again(Each) ->
    receive
        {throw_back, Host, Term} ->
            Host ! {throw_back, self(), Term}
    end,
    throw_again(Each - 1).

%%                          ---- agents ----

agents(Node) ->
    Agent = evaluated(program()),
    Hash = erlang:md5(program()),
    [{host, On} ! {know, Hash, Agent} || On <- [node(), Node]],
    agents("Erlang, evaluated fun", Agent, whole, Node),
    agents("Erlang, known fun", Hash, Hash, Node).

agents(What, Agent, Program, Node) ->
    size(What, {arrive, Agent, facts(1, Program, Node)}),
    told(What, Node, 1,
         fun(Many, Hops) ->
             travel(Agent, facts(Hops div Many, Program, Node), Many)
         end).

travel(Agent, Facts, Many) ->
    [host ! {arrive, Agent, Facts} || _ <- lists:seq(1, Many)],
    [receive done -> ok end || _ <- lists:seq(1, Many)].

facts(Left, Program, Node) ->
    [{left, Left}, {program, Program}, {there, Node}, {here, node()},
     {home, self()} | [{I, {value, I}} || I <- lists:seq(1, 5)]].

%% The source of the agent.

program() ->
    Rules = [io_lib:format("Agent({rule, ~w, X}) -> Y = X + ~w, "
                           "case Y > 0 of true -> Agent({other, Y}) end;~n",
                           [I, I])
             || I <- lists:seq(1, 27)],
    lists:flatten(
      ["fun Agent({arrived, Facts}) ->
            {value, {left, N}, Rest} = lists:keytake(left, 1, Facts),
            Agent({left, N, Rest});
        Agent({left, 0, Facts}) ->
            {home, Home} = lists:keyfind(home, 1, Facts),
            Home ! done;
        ", Rules, "
        Agent({left, N, Facts}) ->
            {there, There} = lists:keyfind(there, 1, Facts),
            {here, Here} = lists:keyfind(here, 1, Facts),
            To = case node() of Here -> There; _ -> Here end,
            Program = case lists:keyfind(program, 1, Facts) of
                {program, whole} -> Agent;
                {program, Hash} -> Hash
            end,
            {host, To} ! {arrive, Program, [{left, N - 1} | Facts]}
        end."]).

evaluated(Source) ->
    {ok, Tokens, _} = erl_scan:string(Source),
    {ok, [Form]} = erl_parse:parse_exprs(Tokens),
    {value, Fun, _} = erl_eval:expr(Form, erl_eval:new_bindings()),
    Fun.

%%                          ---- figures ----

told(What, Node, Times, Run) ->
    Run(1, 4000),                       % warm up
    told(What, "one", Node, Run, 1, 20000 * Times),
    told(What, "ten", Node, Run, 10, 40000 * Times).

told(What, Word, Node, Run, Many, Hops) ->
    Cpu0 = processor_time(Node),
    {Micros, _} = timer:tc(fun() -> Run(Many, Hops) end),
    Cpu1 = processor_time(Node),
    io:format("rates('~s', ~s, ~.1f, ~.1f).~n",
              [What, Word, Hops * 1.0e6 / Micros,
               Hops * 1.0e3 / max(1, Cpu1 - Cpu0)]).

size(What, Message) ->
    io:format("bytes('~s', ~w).~n", [What, erlang:external_size(Message)]).

processor_time(Node) ->
    {Here, _} = statistics(runtime),
    {There, _} = erpc:call(Node, erlang, statistics, [runtime]),
    Here + There.
