------- The small turbine in the files of version 5 -----------------------------
Names and layout as OpenFAST's, values invented
---------------------- SIMULATION CONTROL --------------------------------------
False         Echo            - Echo input data (flag)
         3.01  TMax            - Total run time (s)
          3    ModCoupling     - {1=loose; 2=tight with fixed Jacobian updates; 3=tight}
        0.01   DT              - Time step (s)
        1.0    RhoInf          - Numerical damping parameter (-)
        1e-4   ConvTol         - Convergence iteration error tolerance (-)
          6    MaxConvIter     - Maximum number of convergence iterations (-)
default        AutoRelax       - Adaptive under-relaxation (flag)
---------------------- FEATURE SWITCHES AND FLAGS ------------------------------
          1    NRotors         - Number of rotors in turbine (-)
          2    CompElast       - {1=ElastoDyn; 2=ElastoDyn + BeamDyn for blades; 3=Simplified ElastoDyn}
          1    CompInflow      - {0=still air; 1=InflowWind; 2=external from ExtInflow}
          2    CompAero        - {0=None; 1=AeroDisk; 2=AeroDyn; 3=ExtLoads}
          1    CompServo       - {0=None; 1=ServoDyn}
          0    CompSeaSt       - {0=None; 1=SeaState}
          0    CompHydro       - {0=None; 1=HydroDyn}
          0    CompSub         - {0=None; 1=SubDyn; 2=External Platform MCKF}
          0    CompMooring     - {0=None; 1=MAP++; 2=FEAMooring; 3=MoorDyn; 4=OrcaFlex}
          0    CompIce         - {0=None; 1=IceFloe; 2=IceDyn}
          0    CompSoil        - {0=None; 1=SoilDyn}
          0    MHK             - {0=Not an MHK turbine}
          F    MirrorRotor     - Flag to reverse rotor rotation direction [1 to NRotors] {F=Normal, T=Mirror}
---------------------- ENVIRONMENTAL CONDITIONS --------------------------------
       9.81    Gravity         - (m/s^2)
        1.2    AirDens         - (kg/m^3)
---------------------- INPUT FILES ---------------------------------------------
"elasto.dat"            EDFile       - ElastoDyn
"beam.dat"     BDBldFile(1) - BeamDyn
"beam.dat"     BDBldFile(2) - BeamDyn
"beam.dat"     BDBldFile(3) - BeamDyn
"../parts/wind.dat"     InflowFile   - wind
"aero.dat"              AeroFile     - AeroDyn
"servo.dat"    ServoFile    - ServoDyn
"unused"                SeaStFile    - SeaState
---------------------- VISUALIZATION -------------------------------------------
          0    WrVTK           - none
